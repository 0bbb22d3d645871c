"""Messages of a job about errors of files."""

import errno
import os
import sys

import pytest

from chatterjee1995.workflow.job import _report_file_errors

FULL = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def hidden():
    """Return the error that closing a file raises after writing to it has failed."""
    try:
        try:
            raise FULL
        finally:
            raise AttributeError("no position")
    except AttributeError as error:
        return error


@pytest.mark.parametrize("error", [FULL, hidden()])
def test_a_full_disk_is_told_also_if_another_error_hides_it(error, capsys, monkeypatch):
    monkeypatch.setattr(sys, "excepthook", lambda *_: print("Traceback", file=sys.stderr))
    _report_file_errors()
    sys.excepthook(type(error), error, None)
    told = capsys.readouterr().err
    assert "Error: [Errno 28] No space left on device" in told
    assert ("Traceback" in told) == (error is not FULL)


def test_other_errors_show_their_traceback(capsys, monkeypatch):
    monkeypatch.setattr(sys, "excepthook", lambda *_: print("Traceback", file=sys.stderr))
    _report_file_errors()
    sys.excepthook(ValueError, ValueError("wrong"), None)
    assert capsys.readouterr().err == "Traceback\n"

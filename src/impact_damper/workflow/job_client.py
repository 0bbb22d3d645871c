"""Have a job's script run by the process that has imported what it needs, or run the command.

This stands before the command of a job, with the address of that process (`warm.start`). It is run
by its path and imports of Python's own library only what it must: anything else would take longer
than most jobs do.
"""

import json
import os
import signal
import socket
import sys

# Seconds between two looks whether the run goes on, less than another takes to start a job.
LOOK = 0.5
# Answer that asks for the script to be sent again, with word that it needs the kernels. No exit
# code is as large.
AGAIN = 256


def new_socket():
    """What both ends of a connection are made of: messages come whole, and with open files."""
    return socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)


def main(address, command):
    """Exit as the script does that `command` has this Python run, in the other process.

    Without such a process, and for other commands, become `command`.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # to end without a traceback
    if len(command) == 2 and command[0] == sys.executable:
        run = os.getppid()
        code = _code(address, command[1], run, kernels=False)
        if code == AGAIN:
            code = _code(address, command[1], run, kernels=True)
        if code is not None:
            os._exit(code)
    os.execvp(command[0], command)


def _code(address, script, run, kernels):
    """Exit code of a script in the other process, or AGAIN; None if there is no such process."""
    request = {"script": os.path.abspath(script), "folder": os.getcwd(), "kernels": kernels}
    try:
        with new_socket() as connection:
            connection.connect(address)
            socket.send_fds(connection, [json.dumps(request).encode()], [1, 2])
            answer = _answer(connection, run)
    except OSError:
        return None
    if not answer:
        print(f"Error: the process that ran {request['script']} was killed.", file=sys.stderr)
        sys.stderr.flush()
        return 1
    return int.from_bytes(answer, "big")


def _answer(connection, run):
    """What comes, if the run that waits for this job goes on until then."""
    connection.settimeout(LOOK)
    while os.getppid() == run:
        try:
            return connection.recv(2)
        except TimeoutError:
            pass
    os._exit(1)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])

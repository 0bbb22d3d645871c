"""Have a job's script run by the process that has imported what it needs, or run the command.

This stands before the command of a job, with the address of that process (`warm.start`). Python
runs it by its path, without packages: of the time that a job took to start, a fifth is left.
"""

import json
import os
import signal
import socket
import sys

# Seconds between two looks whether the run goes on, less than another takes to start a job.
LOOK = 0.5
# Exit code of a job that needs the kernels, from a process that has not loaded them yet.
AGAIN = 254
# Set in such a process.
UNLOADED = "IMPACT_DAMPER_KERNELS_NOT_LOADED"


def main(address, command):
    """Exit as the script does that `command` runs by this Python; become any other command."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if len(command) == 2 and command[0] == sys.executable:
        code = _run(address, command[1], kernels=False)
        if code == AGAIN:
            code = _run(address, command[1], kernels=True)
        if code is not None:
            os._exit(code)
    os.execvp(command[0], command)


def _run(address, script, kernels):
    """Exit code of a script in the other process; None if there is no such process."""
    request = {"script": os.path.abspath(script), "folder": os.getcwd(), "kernels": kernels}
    parent = os.getppid()
    try:
        with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as connection:
            connection.connect(address)
            socket.send_fds(connection, [json.dumps(request).encode()], [1, 2])
            answer = _answer(connection, parent)
    except OSError:
        return None
    if not answer:
        print(f"Error: the process that ran {request['script']} was killed.", file=sys.stderr)
        sys.stderr.flush()
        return 1
    return answer[0]


def _answer(connection, parent):
    """What comes, if the run that waits for this job goes on until then."""
    connection.settimeout(LOOK)
    while os.getppid() == parent:
        try:
            return connection.recv(1)
        except TimeoutError:
            pass
    os._exit(1)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])

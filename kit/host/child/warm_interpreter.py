"""An interpreter that has imported what students' processes import, and forks one for each request. See ``kit.host.warm_start``.

A request is a datagram: the working folder and the environment as JSON, with the descriptors that become 0, 1 and 2. The
answer is the id of the process. It is a child of the process that asks, not of this one, has a session of its own, and goes on
where a started one does, at ``supervisor.run``.
"""

from __future__ import annotations

import array
import ctypes
import gc
import json
import os
import signal
import socket
import sys
from typing import Final, NoReturn

from kit.host.child import function_calls, launch_program, node_program, supervisor  # noqa: F401 - to be warm
from kit.ros.execution import client_library  # noqa: F401 - likewise

MAX_REQUEST: Final = 1 << 18
CLONE_PARENT: Final = 0x8000


def serve(clone_call: int) -> NoReturn:
    """Answers requests until the process that asks has gone. ``clone_call``: the number of the system call."""
    del sys.modules[__name__]  # it is none that a program needs
    gc.freeze()  # no collection in what is forked looks through it, which would copy its memory
    requests = socket.socket(fileno=0)
    room = socket.CMSG_SPACE(3 * array.array("i").itemsize)
    while True:
        request, control, _, _ = requests.recvmsg(MAX_REQUEST, room)
        if not request:
            os._exit(0)
        descriptors = array.array("i", control[0][2])
        process = _fork_beside(clone_call)
        if process == 0:
            for target, descriptor in enumerate(descriptors):  # 0 was the socket
                os.dup2(descriptor, target)
        for descriptor in descriptors:
            os.close(descriptor)
        if process == 0:
            _run(*json.loads(request))
        requests.send(str(process).encode())


def _fork_beside(clone_call: int) -> int:
    """Forks a process whose parent is this one's parent, which ``os.fork`` cannot; returns its id, and 0 in it."""
    ctypes.pythonapi.PyOS_BeforeFork()
    call = ctypes.CDLL(None, use_errno=True).syscall
    process: int = call(clone_call, CLONE_PARENT | signal.SIGCHLD, 0, 0, 0, 0)
    if process == 0:
        ctypes.pythonapi.PyOS_AfterFork_Child()
        return 0
    ctypes.pythonapi.PyOS_AfterFork_Parent()
    if process < 0:
        raise OSError(ctypes.get_errno(), "clone")
    return process


def _run(folder: str, environment: dict[str, str]) -> None:
    os.setsid()
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    os._exit(supervisor.run())

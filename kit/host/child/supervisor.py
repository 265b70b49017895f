"""Starts a student's process, runs its file in it, waits for its end, and cleans up.

There are two processes. This one is not confined and does nothing but wait: for the kit to disconnect, or for its
child to end. Then it ends every process that the child has started and removes the run's folder. So nothing of a
student's is left behind, even when the kit itself is killed. The child confines itself, reports that, and only then
receives the student's code: a node program, a launch file or a set of functions.
"""

from __future__ import annotations

import fcntl
import os
import random
import select
import signal
import site
import sys
import termios
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import NoReturn

from kit.host.child import function_calls
from kit.host.child.command_loop import CommandChannel, CommandSession, enable_stack_dumps
from kit.host.child.import_hooks import on_import
from kit.host.child.student_module import STDERR, StudentProgram, explain
from kit.host.sandbox import confinement, process_control, sandbox_config
from kit.host.sandbox.limits import INTERVAL_S, PAUSE_PER_COUNT, exceeds_disk_limit
from kit.host.sandbox.namespaces import unmount_scratch
from kit.host.sandbox.reaper import end_descendants, remove_folder
from kit.host.wire import LOST_PIPE, OVER_DISK_LIMIT

PIPE = 0
"""The pipe to the kit comes in place of the standard input."""

Streams = Sequence[int | None]
"""Descriptors that the program gets as 0, 1 and 2: a terminal or a pipe of the user's. None: nothing of the user's."""


def run() -> int:
    """Runs one student's process; returns the exit status of this one or, in the child, of the child."""
    try:
        return _start_student()
    except EOFError:  # the kit has gone before it had begun
        return 0


def _start_student() -> int:
    channel = CommandChannel(PIPE)
    role, record, streams = channel.receive()
    config = sandbox_config.SandboxConfig.from_json(record)
    process_control.adopt_orphans()
    try:
        is_disk_limited = confinement.prepare(config)
    except sandbox_config.ConfinementError as problem:
        channel.send(["refused", str(problem)])
        return 1
    _preload(role)
    ended, wake = os.pipe()
    os.set_blocking(wake, False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(wake)
    child = os.fork()
    if child == 0:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        os.close(ended)
        os.close(wake)
        return _run_student(role, config, streams)
    for descriptor in {each for each in streams if each is not None and each > 2}:
        os.close(descriptor)
    return _supervise(child, ended, config, is_disk_limited=is_disk_limited)


def _supervise(child: int, ended: int, config: sandbox_config.SandboxConfig, *, is_disk_limited: bool) -> int:
    """Waits for the end, cleans up, and returns the child's exit status: 128 + n for signal n.

    Ends a child that has written more than it may, and returns OVER_DISK_LIMIT, unless ``is_disk_limited``: the file system
    has the limits.
    """
    for number in signal.valid_signals() - {signal.SIGCHLD, signal.SIGKILL, signal.SIGSTOP}:
        with suppress(OSError):
            signal.signal(number, signal.SIG_IGN)
    _redirect_to_null(1, 2)
    poller = select.poll()
    poller.register(PIPE, 0)  # hanging up is always reported
    poller.register(ended, select.POLLIN)
    status = None
    pause_s = None if is_disk_limited else INTERVAL_S
    is_over_disk_limit = False
    while status is None and not is_over_disk_limit:
        ready = [descriptor for descriptor, _ in poller.poll(None if pause_s is None else pause_s * 1000)]
        if PIPE in ready:
            break
        if ended in ready:
            os.read(ended, 512)
            status = _reap(child)
        else:
            began = time.monotonic()
            limits = config.limits
            is_over_disk_limit = exceeds_disk_limit(config.scratch, child, limits.scratch, limits.files)
            pause_s = max(INTERVAL_S, PAUSE_PER_COUNT * (time.monotonic() - began))
    with suppress(OSError):
        os.killpg(child, signal.SIGKILL)
    end_descendants(os.getpid())
    _reap(child)
    if is_disk_limited and not config.makes_namespaces:
        unmount_scratch(config.scratch)
    if not config.in_bubblewrap:  # from inside it is out of reach; the kit, or its next start, removes it
        remove_folder(config.folder)
    if is_over_disk_limit:
        return OVER_DISK_LIMIT
    if status is None:  # the pipe was closed, by the kit or by the child
        return LOST_PIPE
    return _exit_status(status)


def _reap(child: int) -> int | None:
    """Collects every child that has ended; returns the status of ``child`` if it is one of them."""
    status = None
    with suppress(ChildProcessError):
        while True:
            process, outcome = os.waitpid(-1, os.WNOHANG)
            if process == 0:
                break
            if process == child:
                status = outcome
    return status


def _exit_status(status: int) -> int:
    code = os.waitstatus_to_exitcode(status)
    return code if code >= 0 else 128 - code


def _redirect_to_null(*descriptors: int) -> None:
    """Replaces descriptors by /dev/null, so that the parent sees them close when the child ends."""
    null = os.open(os.devnull, os.O_RDWR)
    for descriptor in descriptors:
        os.dup2(null, descriptor)
    os.close(null)


def _run_student(role: str, config: sandbox_config.SandboxConfig, streams: Streams) -> int:
    """Runs in the child: confines it, then runs the student's code."""
    os.setsid()
    if config.makes_namespaces:
        # The first process of a namespace ignores most signals, and its end ends all others: it must not be the
        # student's.
        child = os.fork()
        if child:
            return _run_init_process(child)
        os.setsid()
    channel = CommandChannel(os.dup(PIPE))
    _redirect_to_null(PIPE)
    dumps = _connect_streams(streams)
    try:
        confinement.confine(config)
    except sandbox_config.ConfinementError as problem:
        channel.send(["refused", str(problem)])
        return 1
    channel.send(["confined", int(config.level)])
    return _run_program(role, channel, dumps)


def _connect_streams(streams: Streams) -> int:
    """Gives the program its standard streams; returns the descriptor to which the kit has its errors written."""
    dumps = 2 if streams[2] is None else os.dup(2)
    for target, descriptor in enumerate(streams):
        if descriptor is not None:
            os.dup2(descriptor, target)
    for descriptor in {each for each in streams if each is not None}:
        os.close(descriptor)
    with suppress(OSError):  # a pipe or file: it sends no signals
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)
    return dumps


def _run_init_process(child: int) -> int:
    """Runs as the first process of a namespace: waits for the student's, and collects orphans."""
    _redirect_to_null(PIPE, 1, 2)
    while True:
        process, status = os.wait()
        if process == child:
            return _exit_status(status)


def _preload(role: str) -> None:
    """Imports what a program of this role needs, while compiled modules may still be written."""
    if role == "node":
        import kit.host.child.node_program
    elif role == "launch":
        import kit.host.child.launch_program  # noqa: F401 - likewise


def _run_program(role: str, channel: CommandChannel, dumps: int = STDERR) -> NoReturn:
    """Runs one program from its start to its end, and ends the process.

    ``dumps``: the descriptor to which Python writes its stacks after a deadline.
    """
    sys.dont_write_bytecode = True
    sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]  # a TextIOWrapper: nobody has replaced it yet
    enable_stack_dumps(dumps)
    session = CommandSession(channel)
    _, start = session.next_command()
    session.set_deadline(start["start_s"], start["start_wall_s"])
    session.reply_s, session.reply_wall_s = start["reply_s"], start["reply_wall_s"]
    program = StudentProgram(start["file"], start["source"].encode("latin-1"), start.get("folder"))

    def thread_has_failed(problem: threading.ExceptHookArgs) -> None:
        # A thread that exits ends itself alone, without a word.
        if problem.exc_value is not None and not isinstance(problem.exc_value, SystemExit):
            session.fail(explain(problem.exc_value, program))

    threading.excepthook = thread_has_failed
    os.environ.update(start.get("environment", {}))
    sys.path += [*start.get("imports", ()), *start["libraries"], program.folder]
    _add_site_names()
    _seed_random(start["seed"])
    try:
        if "cwd" in start:
            os.chdir(start["cwd"])
        if role == "node":
            from kit.host.child import node_program

            node_program.run(program, session, start)
        elif role == "launch":
            from kit.host.child import launch_program

            launch_program.run(program, session, start)
        else:
            function_calls.serve(program, session)
    except BaseException as problem:  # noqa: BLE001 - whatever a student's code raises is for the student to read
        session.fail(explain(problem, program))
    raise AssertionError("a program ends by an answer")


def _add_site_names() -> None:
    """Adds the names that ``python FILE`` has from the module ``site``, which is not run here: exit, quit, help and others.

    All of them, so that no program misses one. They are the standard library's own; what ``help`` needs is imported when
    it is called.
    """
    site.setquit()
    site.setcopyright()
    site.sethelper()


def _seed_random(seed: int) -> None:
    """Seeds ``random`` now, and ``numpy.random`` when and if the program imports it."""
    random.seed(seed)
    on_import("numpy", lambda numpy: numpy.random.seed(seed % 2**32))

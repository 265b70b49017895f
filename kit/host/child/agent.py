"""Loads a student's file in the child, and runs it as a node program, a launch file or a set of functions."""

from __future__ import annotations

import os
import sys
import threading
from typing import NoReturn

from kit.host.child import function_calls, seeds
from kit.host.child.command_loop import CommandChannel, CommandSession, enable_stack_dumps
from kit.host.child.student_module import STDERR, StudentProgram, explain


def preload(role: str) -> None:
    """Imports what a program of this role needs, while compiled modules may still be written."""
    if role == "node":
        import kit.host.child.node_program
    elif role == "launch":
        import kit.host.child.launch_program  # noqa: F401 - likewise


def run_program(role: str, channel: CommandChannel, dumps: int = STDERR) -> NoReturn:
    """Runs one program from its start to its end, and ends the process.

    ``dumps``: the descriptor to which Python writes its stacks after a deadline.
    """
    sys.dont_write_bytecode = True
    sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]  # a TextIOWrapper: nobody has replaced it yet
    enable_stack_dumps(dumps)
    session = CommandSession(channel)
    _, start = session.next_command()
    session.set_deadline(start["start_s"])
    session.reply_s = start["reply_s"]
    program = StudentProgram(start["file"], start["source"].encode("latin-1"), start.get("folder"))

    def thread_has_failed(problem: threading.ExceptHookArgs) -> None:
        if problem.exc_value is not None:
            session.fail(explain(problem.exc_value, program))

    threading.excepthook = thread_has_failed
    os.environ.update(start.get("environment", {}))
    sys.path += [*start.get("imports", ()), *start["libraries"], program.folder]
    seeds.seed_random(start["seed"])
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

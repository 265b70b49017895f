"""Loads a student's file in the child, and runs it as a node program, a launch file or a set of functions.

Seeds the student's random numbers: the same in every run with the same seed.
"""

from __future__ import annotations

import os
import random
import sys
import threading
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import TYPE_CHECKING, NoReturn, cast

from kit.host.child import function_calls
from kit.host.child.command_loop import CommandChannel, CommandSession, enable_stack_dumps
from kit.host.child.student_module import STDERR, StudentProgram, explain

if TYPE_CHECKING:
    from importlib.abc import Loader


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
    seed_random(start["seed"])
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


def seed_random(seed: int) -> None:
    """Seeds ``random`` now, and ``numpy.random`` when and if the program imports it."""
    random.seed(seed)
    sys.meta_path.insert(0, _NumpySeeder(seed))


class _NumpySeeder:
    """Import hook (finder and loader) that seeds numpy's global generator once numpy is loaded."""

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._loader: Loader | None = None

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if name != "numpy":
            return None
        sys.meta_path.remove(self)
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and spec.loader is not None:
            self._loader = spec.loader
            spec.loader = cast("Loader", self)
        return spec

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        assert self._loader is not None
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        assert self._loader is not None
        assert module.__spec__ is not None
        module.__spec__.loader = module.__loader__ = self._loader
        self._loader.exec_module(module)
        module.random.seed(self._seed % 2**32)

"""Runs a launch file in the child: requests processes, and reacts to what happens to them."""

from __future__ import annotations

import os

from kit.host.child.command_loop import CommandSession
from kit.host.child.student_module import StudentProgram
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.wire import MAX_TEXT, Json
from kit.ros import install_import_names
from kit.ros.launch.context import LaunchError
from kit.ros.launch.description_sources import MARKUP_SUFFIXES, description_of
from kit.ros.launch.frontend.markup_reader import read_launch_description
from kit.ros.launch.service import LaunchService, Request
from kit.ros.launch.unavailable import install_unavailable_imports
from kit.ros.packages import LAUNCH_VARIABLE

MODULE = "launch_file"
"""The name of the module that the file becomes."""


def run(program: StudentProgram, session: CommandSession, start: dict[str, Json]) -> None:
    """Loads the file and executes it until the parent disconnects; or only answers with its arguments."""
    install_import_names()
    install_unavailable_imports()
    service = LaunchService(program.file, start["arguments"], environment=dict(os.environ))
    os.environ[LAUNCH_VARIABLE] = "1"  # for this process alone
    try:
        if program.file.endswith(MARKUP_SUFFIXES):
            description = read_launch_description(program.file, program.source)
        else:
            description = description_of(program.load(MODULE))
        if start["only_arguments"]:
            session.answer("ended", _describe_arguments(description.get_launch_arguments()))
            return
        requests = service.start(description)
        while True:
            session.answer("reply", service.wake_ns, _truncated(requests))
            _, now_ns, events = session.next_command()
            requests = service.advance(now_ns, events)
    except LaunchError as problem:
        raise _launch_failure(problem, program) from None


def _describe_arguments(declared: list[Json]) -> list[Json]:
    return [["argument", each.name, each.shown_default, each.description, each.choices] for each in declared]


def _truncated(requests: list[Request]) -> list[Json]:
    """Shortens texts to the length that the parent accepts."""
    return [
        [kind, *(part[:MAX_TEXT] if isinstance(part, str) else part for part in content)]
        for kind, *content in requests
    ]


def _launch_failure(problem: LaunchError, program: StudentProgram) -> StudentCodeError:
    file = program.relative_path(problem.location.file) if problem.location else None
    line = problem.location.line if problem.location and file else None
    text = str(problem)
    if problem.location and file is None:
        text = f"{problem.location.file}:{problem.location.line}: {text}"
    return StudentCodeError(Failure(FailureKind.EXCEPTION, text[:MAX_TEXT], file, line))

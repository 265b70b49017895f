"""Runs a launch file in the child: requests processes, and reacts to what happens to them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from kit.host.child.command_loop import CommandSession
from kit.host.child.student_module import StudentProgram, explain
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.wire import MAX_TEXT, Json
from kit.ros import install_import_names
from kit.ros.launch.context import LaunchContext, LaunchError
from kit.ros.launch.description_sources import MARKUP_SUFFIXES, description_of
from kit.ros.launch.frontend.markup_reader import read_launch_description
from kit.ros.launch.service import LaunchService, Request
from kit.ros.launch.testing.runs import read_test_runs
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
    with explained(program, service.context):
        if program.file.endswith(MARKUP_SUFFIXES):
            description = read_launch_description(program.file, program.source)
        else:
            module = program.load(MODULE)
            is_test = start["only_arguments_of"] == "test"
            description = read_test_runs(module)[0].describe()[0] if is_test else description_of(module)
        arguments = description.get_launch_arguments() if start["only_arguments_of"] else None
        requests = [] if start["only_arguments_of"] else service.start(description)
    if arguments is not None:
        session.answer("ended", _describe_arguments(arguments))
        return
    while True:
        session.answer("reply", service.wake_ns, truncated(requests))
        _, now_ns, events = session.next_command()
        with explained(program, service.context):
            requests = service.advance(now_ns, events)


@contextmanager
def explained(program: StudentProgram, context: LaunchContext) -> Iterator[None]:
    """Turns every error of the launch file into StudentCodeError, with the line of the action that was carried out where no
    line of the author's is to blame."""
    try:
        yield
    except LaunchError as problem:
        raise _launch_failure(problem, program, context) from None
    except (Exception, SystemExit) as problem:  # noqa: BLE001 - whatever a launch file raises
        failure = explain(problem, program)
        place = context.location
        if failure.file is None and place is not None:
            failure = replace(failure, file=program.relative_path(place.file), line=place.line)
        raise StudentCodeError(failure) from None


def _describe_arguments(declared: list[Json]) -> list[Json]:
    return [["argument", each.name, each.shown_default, each.description, each.choices] for each in declared]


def truncated(requests: list[Request]) -> list[Json]:
    """Shortens texts to the length that the parent accepts."""
    return [
        [kind, *(part[:MAX_TEXT] if isinstance(part, str) else part for part in content)]
        for kind, *content in requests
    ]


def _launch_failure(
    problem: LaunchError, program: StudentProgram, context: LaunchContext
) -> StudentCodeError:
    file = program.relative_path(problem.location.file if problem.location else context.files[-1])
    line = problem.location.line if problem.location and file else None
    text = str(problem)
    if problem.location and file is None:
        text = f"{problem.location.file}:{problem.location.line}: {text}"
    return StudentCodeError(Failure(FailureKind.EXCEPTION, text[:MAX_TEXT], file, line))

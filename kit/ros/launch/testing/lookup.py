"""Finds, in what a launch test has recorded of its processes, those that a test means: by action, by name, by arguments."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Final, Protocol

from kit.ros.launch.processes import ExecuteProcess

NO_CMD_ARGS: Final = object()
"""In place of arguments: means a process that was started without any."""


class NoMatchingProcessException(Exception):
    """Nothing is recorded of the process that a test means."""


class ProcessRecords(Protocol):
    """What is recorded of processes."""

    def processes(self) -> Iterable[ExecuteProcess]:
        """The actions of all processes of which something is recorded."""


def process_name(process: ExecuteProcess) -> str:
    """The name of a started process in the output, such as ``talker-1``."""
    return str((process.process_details or {}).get("name", ""))


def resolve_processes(
    info_obj: ProcessRecords,
    *,
    process: ExecuteProcess | str | None = None,
    cmd_args: Any = None,
    strict_proc_matching: bool = True,
) -> list[ExecuteProcess]:
    """The processes that are meant: all with None; an action's own; those in whose names the text occurs.

    ``cmd_args`` (a text, texts or NO_CMD_ARGS) tells processes of one name apart; ``strict_proc_matching`` refuses several.
    Raises NoMatchingProcessException if nothing is recorded of any.
    """
    known = list(info_obj.processes())
    if process is None:
        if not known:
            raise NoMatchingProcessException("nothing is recorded of any process")
        return known
    if isinstance(process, ExecuteProcess):
        if process not in known:
            raise NoMatchingProcessException(
                f"nothing is recorded of {process_name(process) or 'a process that has not been started'}"
            )
        return [process]
    if not isinstance(process, str):
        raise TypeError(
            f"a process is given by its action (ExecuteProcess, Node) or its name, not by {type(process).__name__}"
        )
    wanted = [cmd_args] if isinstance(cmd_args, str) else cmd_args
    found = [each for each in known if process in process_name(each) and _has_arguments(each, wanted)]
    names = ", ".join(sorted(map(process_name, known))) or "none"
    if not found:
        raise NoMatchingProcessException(
            f"no process is named {process!r} with arguments {cmd_args!r}; recorded: {names}"
        )
    if strict_proc_matching and len(found) > 1:
        raise Exception(
            f"several processes match the name {process!r} with arguments {cmd_args!r}; recorded: {names}"
        )
    return found


def _has_arguments(process: ExecuteProcess, wanted: Sequence[str] | Any | None) -> bool:
    given = (process.process_details or {}).get("cmd", [])[1:]
    if wanted is None:
        return True
    return not given if wanted is NO_CMD_ARGS else all(each in given for each in wanted)

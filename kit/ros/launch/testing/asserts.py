"""What launch tests assert: of what processes have printed, in which order, and with which exit codes they have ended."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final

from kit.ros.launch.testing.lookup import process_name, resolve_processes
from kit.ros.launch.testing.marks import EXIT_OK

ANSI_ESCAPE: Final = re.compile(r"\x1b\[[0-9;?]*[ -/]*[@-~]")

TextMatch = Callable[[str], bool]


def remove_ansi_escape_sequences(string: str) -> str:
    """Removes what colours a terminal."""
    return ANSI_ESCAPE.sub("", string)


def normalize_lineseps(string: str) -> str:
    """Ends every line as this system does not need to be told: with a line feed."""
    return string.replace("\r\n", "\n")


def build_text_match(expected_text: Any) -> Callable[..., Any]:
    """A function ``(text, start=0)`` that returns where the expected output begins and ends in a text; None if it is not there.

    Expected are a text, a pattern, or a list of either, of which each comes after the one before: texts as whole lines.
    Raises ValueError for anything else.
    """
    if isinstance(expected_text, str):
        wanted = normalize_lineseps(expected_text)

        def match_text(text: str, start: int = 0) -> tuple[int, int] | None:
            at = normalize_lineseps(text).find(wanted, start)
            return None if at < 0 else (at, at + len(wanted))

        return match_text
    if hasattr(expected_text, "search"):

        def match_pattern(text: str, start: int = 0) -> tuple[int, int] | None:
            found = expected_text.search(normalize_lineseps(text), start)
            return None if found is None else (found.start(), found.end())

        return match_pattern
    if isinstance(expected_text, Sequence) and expected_text:
        lines = [
            build_text_match(
                re.compile(rf"^{re.escape(each)}$", re.MULTILINE) if isinstance(each, str) else each
            )
            for each in expected_text
        ]

        def match_all(text: str, start: int = 0) -> tuple[int, int] | None:
            places = []
            for match in lines:
                place = match(text, start)
                if place is None:
                    return None
                places.append(place)
                start = place[1]
            return places[0][0], places[-1][1]

        return match_all
    raise ValueError(f"expected output is a text, a pattern or a list of these, not {expected_text!r}")


def assert_in_stream(
    proc_output: Any,
    expected_output: Any,
    process: Any,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
    stream: str = "stderr",
) -> None:
    """Asserts that one of the processes that are meant has printed the expected output on ``stdout`` or ``stderr``."""
    if stream not in ("stdout", "stderr"):
        raise ValueError(f"a stream is 'stdout' or 'stderr', not {stream!r}")
    if output_filter is not None and not callable(output_filter):
        raise ValueError("output_filter is not callable")
    match = build_text_match(expected_output)
    found = resolve_processes(
        proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    )
    for each in found:
        printed = "".join(
            line.text.decode() for line in proc_output[each] if line.from_stdout == (stream == "stdout")
        )
        if strip_ansi_escape_sequences:
            printed = remove_ansi_escape_sequences(printed)
        if output_filter is not None:
            printed = output_filter(printed)
        if match(printed) is not None:
            return
    names = ", ".join(sorted(map(process_name, found)))
    raise AssertionError(
        f"Did not find {expected_output!r} on {stream} of any of the matching processes: {names}"
    )


def assert_in_stdout(
    proc_output: Any, expected_output: Any, process: Any, cmd_args: Any = None, **options: Any
) -> None:
    """Asserts that a process has printed the expected output on stdout; options as of ``assertInStream``."""
    assert_in_stream(proc_output, expected_output, process, cmd_args, **options, stream="stdout")


def assert_in_stderr(
    proc_output: Any, expected_output: Any, process: Any, cmd_args: Any = None, **options: Any
) -> None:
    """Asserts that a process has printed the expected output on stderr, where logs go; options as of ``assertInStream``."""
    assert_in_stream(proc_output, expected_output, process, cmd_args, **options, stream="stderr")


def assert_exit_codes(
    proc_info: Any,
    allowable_exit_codes: Sequence[int] = (EXIT_OK,),
    process: Any = None,
    cmd_args: Any = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Asserts that the processes that are meant, by default all, have ended with one of these exit codes."""
    for allowed in allowable_exit_codes:
        if not isinstance(allowed, int):
            raise AssertionError(f"Provided exit code {allowed} is not an int")
    for each in resolve_processes(
        proc_info, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    ):
        code = getattr(proc_info[each], "returncode", None)
        if code not in allowable_exit_codes:
            raise AssertionError(f"Proc {process_name(each)} exited with code {code}")


class SequentialTextChecker:
    """Asserts that texts come one after the other in what a process has printed."""

    def __init__(self, output: Sequence[str]) -> None:
        self._text, self._place = "".join(output), 0

    def assertInText(self, msg: str) -> None:  # noqa: N802 - launch_testing's names
        """Asserts that the text comes after the one before. Raises AssertionError."""
        at = self._text.find(msg, self._place)
        if at < 0:
            raise AssertionError(
                f"'{msg}' not found in sequence after previous match. "
                f"The output near the last matched line:\n{self.get_nearby_lines()}"
            )
        self._place = at + len(msg)

    assertInStdout = assertInText  # noqa: N815

    def get_nearby_lines(self) -> str:
        """The line of the last match, with two lines before and after it."""
        lines = self._text.split("\n")
        line = self._text.count("\n", 0, self._place)
        return "\n".join(lines[max(0, line - 2) : line + 3])


@contextmanager
def assert_sequential_stdout(
    proc_output: Any, process: Any, cmd_args: Any = None
) -> Iterator[SequentialTextChecker]:
    """A context manager whose checker asserts that texts come one after the other in what one process has printed."""
    (found,) = resolve_processes(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=True)
    yield SequentialTextChecker([each.text.decode() for each in proc_output[found]])

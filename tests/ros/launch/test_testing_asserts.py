"""What launch tests assert of recorded output and ends."""

from __future__ import annotations

import re
from typing import Any

import pytest

from kit.ros.graph.graph import Graph
from kit.ros.launch.events import ProcessExited, ProcessIO
from kit.ros.launch.processes import ExecuteProcess
from kit.ros.launch.testing.asserts import (
    SequentialTextChecker,
    assert_exit_codes,
    assert_in_stderr,
    assert_in_stdout,
)
from kit.ros.launch.testing.lookup import NO_CMD_ARGS, NoMatchingProcessException, resolve_processes
from kit.ros.launch.testing.records import ActiveIoHandler, IoHandler, ProcInfoHandler


def started(name: str, *arguments: str) -> ExecuteProcess:
    action = ExecuteProcess(cmd=["true", *arguments])
    action.process_details = {"cmd": ["true", *arguments], "name": name}
    return action


TALKER, FAST = started("talker-1"), started("talker-2", "--fast")


def printed(*lines: tuple[ExecuteProcess, str, bool], records: Any = None) -> Any:
    records = records or IoHandler()
    for action, text, is_out in lines:
        name = (action.process_details or {})["name"]
        records.append(ProcessIO(action=action, name=name, text=f"{text}\n".encode(), from_stdout=is_out))
    return records


OUTPUT = printed((TALKER, "one", True), (TALKER, "\x1b[31mtwo\x1b[0m", True), (FAST, "lost", False))


@pytest.mark.parametrize(
    "expected",
    ["ne\ntw", "two", ["one", "two"], re.compile("^t.o$", re.MULTILINE), [re.compile("o.e"), "two"]],
)
def test_expected_output_is_found(expected: Any) -> None:
    assert_in_stdout(OUTPUT, expected, TALKER)


@pytest.mark.parametrize("expected", ["lost", ["two", "one"], ["ne"], re.compile("three")])
def test_other_output_is_not(expected: Any) -> None:
    with pytest.raises(AssertionError, match="talker-1"):
        assert_in_stdout(OUTPUT, expected, TALKER)


def test_streams_and_filters_are_kept_apart() -> None:
    assert_in_stderr(OUTPUT, "lost", "talker", "--fast")
    assert_in_stderr(OUTPUT, "LOST", FAST, output_filter=str.upper)
    with pytest.raises(AssertionError):
        assert_in_stdout(OUTPUT, "lost", FAST)
    with pytest.raises(ValueError, match="pattern"):
        assert_in_stdout(OUTPUT, 3, FAST)


def test_a_process_is_meant_by_action_name_and_arguments() -> None:
    assert resolve_processes(OUTPUT) == [TALKER, FAST]
    assert resolve_processes(OUTPUT, process="talker", cmd_args=NO_CMD_ARGS) == [TALKER]
    assert resolve_processes(OUTPUT, process="talker", strict_proc_matching=False) == [TALKER, FAST]
    with pytest.raises(Exception, match="several processes"):
        resolve_processes(OUTPUT, process="talker")
    with pytest.raises(NoMatchingProcessException, match="talker-1, talker-2"):
        resolve_processes(OUTPUT, process="listener")
    with pytest.raises(NoMatchingProcessException):
        resolve_processes(OUTPUT, process=started("other-3"))
    with pytest.raises(TypeError):
        resolve_processes(OUTPUT, process=3)  # type: ignore[arg-type]  # that is the test


def test_exit_codes() -> None:
    ends = ProcInfoHandler()
    ends.append(ProcessExited(action=TALKER, name="talker-1", pid=1, returncode=0))
    assert_exit_codes(ends)
    ends.append(ProcessExited(action=FAST, name="talker-2", pid=2, returncode=7))
    assert_exit_codes(ends, [0, 7])
    assert_exit_codes(ends, process=TALKER)
    with pytest.raises(AssertionError, match="talker-2 exited with code 7"):
        assert_exit_codes(ends)


def test_texts_come_one_after_the_other() -> None:
    checker = SequentialTextChecker(["a b\n", "c\n", "b\n"])
    checker.assertInText("b")
    checker.assertInText("c")
    checker.assertInText("b")
    with pytest.raises(AssertionError, match="not found in sequence"):
        checker.assertInText("c")


def test_a_wait_for_the_other_stream_says_so() -> None:
    graph = Graph(None)
    records = printed((TALKER, "hello", True), records=ActiveIoHandler(graph))
    with pytest.raises(AssertionError, match="say stream='stdout'"):
        records.assertWaitFor("hello", timeout=0)
    assert records.waitFor("hello", stream="stdout", timeout=0)

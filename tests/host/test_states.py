"""Every kind of frame in every state of the session: taken where the table says so, else the child's fault."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.process import Role, StudentProcess
from kit.host.protocol import ALLOWED_FRAMES, Confined, ConfinementRefused, ProcessState, parse
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL
from tests.host.conftest import LINUX, QUICK, Speaker, Student

FRAMES: dict[str, Callable[[int], list[Any]]] = {
    "confined": lambda seq: ["confined", int(INTERACTIVE_LEVEL)],
    "refused": lambda seq: ["refused", "no Landlock here"],
    "reply": lambda seq: ["reply", seq, None, []],
    "functions": lambda seq: ["functions", seq, ["f"]],
    "values": lambda seq: ["values", seq, ""],
    "told": lambda seq: ["told", seq, None],
    "ended": lambda seq: ["ended", seq, []],
    "failed": lambda seq: ["failed", seq, "exception", "E", None, None, 1],
}

ROLES: dict[ProcessState, Role] = {
    ProcessState.STARTING_NODE: "node",
    ProcessState.STARTING_LAUNCH: "launch",
    ProcessState.TICKING: "node",
    ProcessState.IDLE: "node",
}
"""By state, the role of a child that comes to it; "functions" where nothing is said."""

QUESTIONS = {
    ProcessState.TICKING: "tick",
    ProcessState.CALLING_BATCH: "call",
    ProcessState.CALLING_JSON: "tell",
    ProcessState.IDLE: "tick",
}


@pytest.fixture
def speaks(student: Student, speaker: Speaker) -> Callable[..., StudentProcess]:
    """Starts a child that takes these steps."""

    def start(role: Role, *steps: list[Any] | None) -> StudentProcess:
        speaker(*steps)
        return StudentProcess(role, student(""), {"seed": 0}, limits=QUICK)

    return start


def failure_of(child: StudentProcess, state: ProcessState) -> Failure | None:
    """Talks with a child as the parent would, until it has taken the frame that is tried in this state."""
    try:
        child.wait_started()
        if state is ProcessState.IDLE:
            wait_for(child)
        if state in QUESTIONS:
            child.request(QUESTIONS[state])
    except StudentCodeError as error:
        return error.failure
    return None


@LINUX
@pytest.mark.parametrize("state", ProcessState)
@pytest.mark.parametrize("kind", FRAMES)
def test_every_frame_in_every_state(
    speaks: Callable[..., StudentProcess], kind: str, state: ProcessState
) -> None:
    role = ROLES.get(state, "functions")
    first = ["functions", 0, ["f"]] if role == "functions" else ["reply", 0, None, []]
    seq = 1 if state in QUESTIONS else 0
    tried = FRAMES[kind](seq)
    steps: list[list[Any] | None] = [None]
    if state is not ProcessState.CONFINING:
        steps += [["confined", int(INTERACTIVE_LEVEL)], None]
    if state is ProcessState.CONFINING and kind == "confined":
        tried, steps = first, [None, tried, None]
    if state in QUESTIONS:
        steps.append(first)
        if state is not ProcessState.IDLE:
            steps.append(None)
    is_allowed = isinstance(parse(FRAMES[kind](seq)), ALLOWED_FRAMES[state])
    expected = {"refused": FailureKind.CONFINEMENT, "failed": FailureKind.EXCEPTION}.get(kind)
    with speaks(role, *steps, tried) as child:
        failure = failure_of(child, state)
    if is_allowed:
        assert (failure and failure.kind) is expected
    else:
        assert failure is not None
        assert failure.kind is FailureKind.PROTOCOL


def wait_for(child: StudentProcess) -> None:
    """Waits until something that nobody asked for lies in the pipe, at most 20 s."""
    child._poller.poll(20_000)


def test_only_the_code_above_the_students_can_say_that_a_machine_cannot_confine() -> None:
    """And it can say nothing after the student's code was sent."""
    before = {Confined, ConfinementRefused}
    for state, kinds in ALLOWED_FRAMES.items():
        assert set(kinds) == before if state is ProcessState.CONFINING else not before & set(kinds)
    assert {kind for kinds in ALLOWED_FRAMES.values() for kind in kinds} == {
        type(parse(frame(0))) for frame in FRAMES.values()
    }

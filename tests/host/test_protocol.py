"""What a child may say."""

from __future__ import annotations

import copy
import random
from array import array

import pytest

from kit.host import wire
from kit.host.failure import Failure, FailureKind
from kit.host.protocol import (
    BatchResult,
    Confined,
    ConfinementRefused,
    Ended,
    Failed,
    FunctionNames,
    GraphEvent,
    JsonResult,
    Reply,
    parse,
)
from kit.host.wire import Json, ProtocolError
from tests.cases import every_case

GOOD: list[tuple[list[Json], object]] = [
    (["confined", 1], Confined(1)),
    (["refused", "no"], ConfinementRefused("no")),
    (["reply", 3, None, []], Reply(3, None, ())),
    (
        ["reply", 3, 100, [["gone", 7], ["publish", 1, [0.5]]]],
        Reply(3, 100, (GraphEvent("gone", [7]), GraphEvent("publish", [1, [0.5]]))),
    ),
    (["functions", 0, ["reward"]], FunctionNames(0, ("reward",))),
    (["values", 9, wire.numbers_to_text(array("d", [1, 2.5]))], BatchResult(9, array("d", [1.0, 2.5]))),
    (["told", 4, [1, True, None, "left", [2.5]]], JsonResult(4, [1.0, True, None, "left", [2.5]])),
    (["ended", 2, []], Ended(2, ())),
    (
        ["failed", 2, "exception", "E: x", "a.py", 3, 1],
        Failed(2, Failure(FailureKind.EXCEPTION, "E: x", "a.py", 3)),
    ),
    (["failed", 2, "exit", "left", None, None, 7], Failed(2, Failure(FailureKind.EXIT, "left", status=7))),
]


@every_case(("content", "frame"), GOOD, ids=[str(content[0]) for content, _ in GOOD])
def test_good_frames(content: list[Json], frame: object) -> None:
    assert parse(content) == frame


@every_case(
    "content",
    [
        None,
        [],
        {},
        "reply",
        ["unheard of", 1],
        [["reply"], 1, None, []],
        ["reply", 1, None],
        ["reply", 1, None, [], 0],
        ["reply", True, None, []],
        ["reply", -1, None, []],
        ["reply", 1, 0.5, []],
        ["reply", 1, -1, []],
        ["reply", 1, None, None],
        ["reply", 1, None, [[]]],
        ["reply", 1, None, [[1]]],
        ["values", 1, [1.0]],
        ["values", 1, None],
        ["values", 1, "AAAA"],
        ["values", 1, "AAAAAAAA8D8"],
        ["values", 1, "AAAAAAAA 8D8="],
        ["values", 1, wire.numbers_to_text(array("d", [float("inf")]))],
        ["values", 1, wire.numbers_to_text(array("d", [float("nan")]))],
        ["told", 1, {"a": 1}],
        ["told", 1, [[[[1]]]]],
        ["told", 1, "x" * (wire.MAX_TEXT + 1)],
        ["functions", 0, ["x" * 256]],
        ["confined", 4],
        ["confined", "1"],
        ["failed", 1, "timeout", "a child cannot say this of itself", None, None, 1],
        ["failed", 1, "heroic", "", None, None, 1],
        ["failed", 1, "exit", "x" * 4_001, None, None, 1],
        ["failed", 1, "exit", "", "a.py", "3", 1],
        ["failed", 1, "exit", "", "a.py", 3],
        ["failed", 1, "exit", "", "a.py", 3, 256],
    ],
    ids=str,
)
def test_bad_frames(content: Json) -> None:
    with pytest.raises(ProtocolError):
        parse(content)


def test_a_thousand_broken_frames_are_understood_or_refused() -> None:
    """One value of a good frame is exchanged for another one: the outcome is a frame or a refusal."""
    chance = random.Random(1)
    values: list[Json] = [
        None,
        True,
        -1,
        0,
        2**70,
        0.5,
        float("nan"),
        float("inf"),
        "",
        "x" * 5000,
        [],
        [[]],
        {},
        {"a": 1},
    ]
    for _ in range(1000):
        content = copy.deepcopy(chance.choice(GOOD)[0])
        target = content
        while True:
            at = chance.randrange(len(target))
            if isinstance(target[at], list) and target[at] and chance.random() < 0.7:
                target = target[at]
            else:
                break
        target[at] = chance.choice(values)
        try:
            frame = parse(content)
        except ProtocolError as problem:
            assert str(problem).isprintable()  # noqa: PT017 - either outcome is right
        else:
            hash(frame.__class__)


def test_a_childs_words_are_made_printable() -> None:
    frame = parse(["failed", 1, "exception", "\x1b]0;title\x07", "a\n.py", 3, 1])
    assert isinstance(frame, Failed)
    assert frame.failure.message.isprintable()
    assert str(frame.failure).isprintable()

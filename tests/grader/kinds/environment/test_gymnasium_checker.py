"""Values and spaces that a student's process describes are rebuilt, or refused: never trusted."""

from __future__ import annotations

import math
import random
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import data_equivalence

from grader.kinds.environment import environment_examiner
from grader.kinds.environment.described_values import (
    MAX_DEPTH,
    MAX_DIMENSIONS,
    MAX_NUMBERS,
    MAX_PARTS,
    MAX_SIZE,
    UnknownSpace,
    UnknownValue,
    check_description,
    check_shape,
    clean_space,
    is_in_space,
    rebuild_space,
    rebuild_value,
)
from grader.kinds.environment.gymnasium_checker import first_checker_complaint
from kit.host.wire import ProtocolError
from tests.cases import every_case


class Own:
    """A class of a student's own."""


@every_case(
    "value",
    [
        True,
        np.bool_(False),
        3,
        2.5,
        np.float32(0.1),
        np.int64(-4),
        None,
        "text",
        {"steps": 3, "near": [1.0, 2.0]},
        np.arange(6, dtype=np.float32).reshape(2, 3),
        np.array([True, False]),
        (np.zeros(9, dtype=np.float32), 1.0, False, True, {}),
    ],
)
def test_a_value_comes_back_as_it_was(value: Any) -> None:
    content = environment_examiner.describe_value(value)
    check_description(content)
    again = rebuild_value(content)
    assert data_equivalence(value, again, exact=True)


def test_what_cannot_be_rebuilt_is_unknown() -> None:
    for value in (Own(), np.zeros(2000), np.array(["a"])):
        content = environment_examiner.describe_value(value)
        check_description(content)
        assert isinstance(rebuild_value(content), UnknownValue)
    assert math.isnan(rebuild_value(environment_examiner.describe_value(math.inf)))


def nested(depth: int) -> Any:
    """A number in so many lists, less one."""
    value: Any = 1
    for _ in range(depth - 1):
        value = [value]
    return value


@every_case(
    ("most", "beyond"),
    [
        (np.zeros(MAX_NUMBERS), np.zeros(MAX_NUMBERS + 1)),
        ((0,) * MAX_PARTS, (0,) * (MAX_PARTS + 1)),
        ([0.0] * MAX_PARTS, [0.0] * (MAX_PARTS + 1)),
        (nested(MAX_DEPTH), nested(MAX_DEPTH + 1)),
    ],
)
def test_values_are_rebuilt_up_to_their_limits_and_beyond_are_unknown(most: Any, beyond: Any) -> None:
    whole, cut = (rebuild_value(environment_examiner.describe_value(value)) for value in (most, beyond))
    assert data_equivalence(most, whole, exact=True)
    assert "UnknownValue" in repr(cut)
    again = rebuild_value(environment_examiner.describe_value(beyond))
    assert data_equivalence(cut, again, exact=True), "the same info twice"


def test_a_longer_list_does_not_lie_in_the_space_of_what_is_sent_of_it() -> None:
    space = gymnasium.spaces.Box(0.0, 1.0, shape=(MAX_PARTS,))
    for count, lies in ((MAX_PARTS, True), (MAX_PARTS + 1, False)):
        value = rebuild_value(environment_examiner.describe_value([0.0] * count))
        assert is_in_space(space, value) == lies


def test_shapes_and_spaces_have_limits() -> None:
    assert check_shape([1] * (MAX_DIMENSIONS - 1) + [MAX_SIZE])[-1] == MAX_SIZE
    for shape in ([1] * (MAX_DIMENSIONS + 1), [MAX_SIZE + 1]):
        with pytest.raises(ProtocolError):
            check_shape(shape)
    for limit, make in ((MAX_SIZE, gymnasium.spaces.Discrete), (MAX_NUMBERS, box)):
        whole, beyond = (
            rebuild_space(environment_examiner.describe_space(make(limit + more))) for more in (0, 1)
        )
        assert whole == make(limit)
        assert isinstance(beyond, UnknownSpace)


def box(size: int) -> gymnasium.Space[Any]:
    return gymnasium.spaces.Box(0.0, 1.0, shape=(size,))


@every_case(
    "space",
    [
        gymnasium.spaces.Discrete(3),
        gymnasium.spaces.Discrete(3, start=1),
        gymnasium.spaces.Box(0.0, 2.0, shape=(9,), dtype=np.float32),
        gymnasium.spaces.Box(-np.inf, np.inf, shape=(2, 2), dtype=np.float64),
        gymnasium.spaces.Box(0, 255, shape=(4,), dtype=np.uint8),
        gymnasium.spaces.Box(0.0, 1.0, shape=(0,)),
    ],
)
def test_a_space_comes_back_as_it_was(space: Any) -> None:
    again = rebuild_space(environment_examiner.describe_space(space))
    assert again == space
    assert clean_space(environment_examiner.describe_space(space))["kind"] == type(space).__name__
    assert is_in_space(again, space.sample())
    assert not is_in_space(again, None if isinstance(space, gymnasium.spaces.Box) else 17)


@every_case(
    "content",
    [
        None,
        7,
        {"kind": "Discrete", "n": 0, "start": 0},
        {"kind": "Discrete", "n": 10**30, "start": 0},
        {"kind": "Box", "shape": [10**9, 10**9], "dtype": "float32", "lows": [], "highs": []},
        {"kind": "Box", "shape": [1], "dtype": "object", "lows": [0.0], "highs": [1.0]},
        {"kind": "Box", "shape": [1], "dtype": "float32", "lows": [[0.0]], "highs": [1.0]},
        {"kind": ["Box"], "shape": {}},
    ],
)
def test_nothing_lies_in_a_forged_space(content: Any) -> None:
    assert not is_in_space(rebuild_space(content), np.zeros(1, dtype=np.float32))
    assert set(clean_space(content)) == {"kind"}


def test_a_description_of_another_form_is_refused() -> None:
    """Whatever passes can be rebuilt; no input brings the grader down."""
    rng = random.Random(1)
    names = (
        "kind",
        "value",
        "count",
        "parts",
        "values",
        "items",
        "numbers",
        "shape",
        "dtype",
        "numpy",
        "text",
    )
    kinds = (
        "tuple",
        "list",
        "dict",
        "ndarray",
        "bool",
        "int",
        "float",
        "float32",
        "uint8",
        "str",
        "NoneType",
        "odd",
    )

    def make(depth: int) -> Any:
        choice = rng.randrange(9 if depth else 6)
        if choice < 6:
            return (None, True, rng.randrange(-3, 20), 1.5, rng.choice(kinds), 10**18)[choice]
        if choice == 6:
            return [make(depth - 1) for _ in range(rng.randrange(4))]
        return {"kind": rng.choice(kinds)} | {
            rng.choice(names): make(depth - 1) for _ in range(rng.randrange(4))
        }

    refused = 0
    for _ in range(3000):
        content = make(4)
        try:
            check_description(content)
        except ProtocolError:
            refused += 1
        else:
            rebuild_value(content)
        rebuild_space(content)
        clean_space(content)
    assert 1000 < refused < 3000


def test_the_checker_asks_for_the_same_actions_every_time() -> None:
    spaces = {
        "action_space": environment_examiner.describe_space(gymnasium.spaces.Discrete(1000)),
        "observation_space": environment_examiner.describe_space(gymnasium.spaces.Discrete(2)),
    }

    def actions() -> list[object]:
        calls: list[dict[str, Any]] = []
        seeds: list[int] = []

        def forward(question: dict[str, Any]) -> dict[str, Any]:
            calls.append(question)
            is_reset = question["call"] == "reset"
            value: Any = (0, {}) if is_reset else (0, 0.0, False, False, {})
            seeds.extend([question["keywords"].get("seed", len(calls))] if is_reset else [])
            return {"returned": environment_examiner.describe_value(value), "generator": str(seeds[-1])}

        first_checker_complaint(forward, spaces)
        return [each["action"] for each in calls if each["call"] == "step"]

    first = actions()
    assert first
    assert all(actions() == first for _ in range(3))

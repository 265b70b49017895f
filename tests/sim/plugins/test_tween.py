"""Bodies that go to and fro: the numbers of Flatland's own test, and what it lacks."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import pytest

from kit.geometry import Pose
from kit.msg.std_msgs import Bool
from kit.sim.plugins.tween import EASINGS
from kit.sim.simulation import Simulation
from kit.world.problems import WorldError
from tests.cases import every_case
from tests.sim.workshop import Workshop


def tweened(
    workshop: Workshop, at: tuple[float, ...] = (0, 0, 0), *, step_size: float = 0.5, **keys: Any
) -> Simulation:
    plugin = {"type": "Tween", "name": "tween", "body": "base", **keys}
    model = workshop.model(workshop.circle(0.1), type="kinematic", plugins=[plugin])
    return Simulation(workshop.world({"robot": model}, poses={"robot": at}), step_size=step_size)


def places(simulation: Simulation, steps: int) -> list[Pose]:
    found = []
    for _ in range(steps):
        simulation.step()
        found.append(simulation.pose(simulation.model_names[0]))
    return found


ONCE = {"delta": [1, 3, 2], "duration": 1, "mode": "once"}
YOYO = {"delta": [10, 10, 1], "duration": 1, "mode": "yoyo"}
LOOP = {"delta": [10, 10, 1], "duration": 2, "mode": "loop"}
EXPECTED = {
    "once": ((2, 1, 0), ONCE, [(2.5, 2.5, 1), (3, 4, 2), (3, 4, 2)]),
    "yoyo": ((0, 0, 0), YOYO, [(5, 5, 0.5), (10, 10, 1), (5, 5, 0.5), (0, 0, 0), (5, 5, 0.5)]),
    "loop": (
        (0, 0, 0),
        LOOP,
        [(2.5, 2.5, 0.25), (5, 5, 0.5), (7.5, 7.5, 0.75), (10, 10, 1), (2.5, 2.5, 0.25), (5, 5, 0.5)],
    ),
}


@pytest.mark.parametrize("mode", EXPECTED)
def test_modes(workshop: Workshop, mode: str) -> None:
    at, keys, expected = EXPECTED[mode]
    theirs = workshop.find(f"flatland:flatland_plugins/test/tween_tests/{mode}.world.yaml")
    for simulation in (tweened(workshop, at, **keys), Simulation(theirs, step_size=0.5)):
        for place, wanted in zip(places(simulation, len(expected)), expected, strict=True):
            assert place == pytest.approx(wanted, abs=1e-5)


@pytest.mark.parametrize("mode", EXPECTED)
def test_modes_on_worlds_of_ours(workshop: Workshop, mode: str) -> None:
    at, keys, expected = EXPECTED[mode]
    for place, wanted in zip(places(tweened(workshop, at, **keys), len(expected)), expected, strict=True):
        assert place == pytest.approx(wanted, abs=1e-9)


def test_short_steps_go_as_fast(workshop: Workshop) -> None:
    """Flatland counts whole milliseconds: below one it stands still."""
    simulation = tweened(workshop, step_size=0.0005, **ONCE)
    simulation.step(1000)
    assert simulation.pose("robot") == pytest.approx((0.5, 1.5, 1))


def test_a_trigger_sends_it_there_and_back(workshop: Workshop) -> None:
    simulation = tweened(workshop, mode="trigger", trigger_topic="open", delta=[2, 0, 0])
    assert [place.x for place in places(simulation, 2)] == [0, 0]
    simulation.accept("/open", Bool(data=True))
    assert [place.x for place in places(simulation, 3)] == [1, 2, 2]
    simulation.accept("/open", Bool(data=False))
    assert [place.x for place in places(simulation, 3)] == [1, 0, 0]


def test_it_goes_on_from_where_it_was_put(workshop: Workshop) -> None:
    simulation = tweened(workshop, mode="yoyo", delta=[10, 0, 0])
    simulation.step()
    simulation.move_model("robot", Pose(100, 7, 0))
    assert [place[:2] for place in places(simulation, 3)] == [(105, 7), (100, 7), (95, 7)]
    simulation.reset()
    assert simulation.pose("robot") == (0, 0, 0)
    assert places(simulation, 1)[0].x == 5


def test_nothing_stops_it(workshop: Workshop) -> None:
    plugin = {"type": "Tween", "name": "tween", "body": "base", "mode": "once", "delta": [2, 0, 0]}
    model = workshop.model(workshop.circle(0.1), plugins=[plugin])
    simulation = Simulation(workshop.world({"robot": model}, {"walls": [[1, -1, 1, 1]]}))
    for _ in range(99):
        before = simulation.pose("robot").x
        simulation.step()
        assert simulation.pose("robot").x == pytest.approx(before + 0.02)
    simulation.step()
    assert simulation.pose("robot").x == 2


@every_case("name", EASINGS)
def test_every_easing_goes_all_the_way(name: str) -> None:
    curve = EASINGS[name]
    assert (curve(0), curve(1)) == pytest.approx((0, 1), abs=1e-12)
    values = [curve(i / 1000) for i in range(1001)]
    assert all(abs(b - a) < 0.15 for a, b in pairwise(values))
    assert -0.4 < min(values) <= max(values) < 1.4


def test_in_and_out_are_mirror_images() -> None:
    assert len(EASINGS) == 28
    for name in {name.removesuffix("InOut") for name in EASINGS if name.endswith("InOut")}:
        for i in range(101):
            t = i / 100
            assert EASINGS[f"{name}Out"](t) == pytest.approx(1 - EASINGS[f"{name}In"](1 - t))
            assert EASINGS[f"{name}InOut"](t) == pytest.approx(1 - EASINGS[f"{name}InOut"](1 - t))


@every_case(
    ("name", "t", "value"),
    [
        ("quadraticIn", 0.5, 0.25),
        ("quinticOut", 0.5, 1 - 1 / 32),
        ("exponentialIn", 0.5, 2**-5),
        ("circularIn", 0.6, 0.2),
        ("backIn", 0.5, -0.0876975),
        ("elasticIn", 0.7, -(2**-3) * math.sin(-0.375 * math.tau / 0.3)),
        ("bounceOut", 1 / 2.75, 1),
        ("bounceOut", 0.5, 0.765625),
        ("linear", 0.3, 0.3),
    ],
)
def test_some_values(name: str, t: float, value: float) -> None:
    assert EASINGS[name](t) == pytest.approx(value)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"mode": "twice"}, "twice"),
        ({"easing": "quadratic"}, "quadraticIn"),
        ({"duration": 0}, "duration"),
        ({"mode": "trigger"}, "trigger_topic"),
    ],
)
def test_mistakes(workshop: Workshop, keys: dict[str, Any], words: str) -> None:
    with pytest.raises(WorldError, match=words):
        tweened(workshop, **keys)

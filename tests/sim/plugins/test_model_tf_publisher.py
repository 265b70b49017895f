"""Where bodies are, for tf: the numbers of Flatland's own test."""

from __future__ import annotations

import math

import pytest

from kit.geometry import Pose
from kit.sim.simulation import Simulation
from kit.world.problems import WorldError
from tests.sim.workshop import Workshop

AT = (8, 6, -0.575958653)
FOLDER = "flatland:flatland_plugins/test/model_tf_publisher_tests"


def frames(simulation: Simulation) -> dict[tuple[str, str], Pose]:
    """Each child frame in its parent."""
    found = {}
    for out in simulation.step():
        assert out.topic == "/tf"
        for stamped in out.message.transforms:
            place, turn = stamped.transform.translation, stamped.transform.rotation
            pose = Pose(place.x, place.y, 2 * math.atan2(turn.z, turn.w))
            found[stamped.header.frame_id, stamped.child_frame_id] = pose
    return found


@pytest.mark.parametrize("name", ["tf/antenna.world.yaml", f"{FOLDER}/tf_publish_test_A/world.yaml"])
def test_with_a_reference_and_the_world(workshop: Workshop, name: str) -> None:
    found = frames(Simulation(workshop.find(name)))
    reference = "my_robot_antenna"
    assert set(found) == {
        ("world", reference),
        *((reference, f"my_robot_{body}") for body in ("base", "left_wheel", "right_wheel")),
    }
    world = found["world", reference]
    base = world.compose(found[reference, "my_robot_base"])
    assert world == pytest.approx(AT, abs=1e-5)
    assert base == pytest.approx(AT, abs=1e-5)
    for side, y in (("left", 1), ("right", -1)):
        wheel = world.compose(found[reference, f"my_robot_{side}_wheel"])
        assert base.relative(wheel) == pytest.approx((-0.25, y, 0), abs=1e-5)


@pytest.mark.parametrize("name", ["tf/world.yaml", f"{FOLDER}/tf_publish_test_B/world.yaml"])
def test_by_default(workshop: Workshop, name: str) -> None:
    found = frames(Simulation(workshop.find(name)))
    expected = {
        "antenna": (0, 0, 0),
        "left_wheel": (-0.25, 1, 0),
        "right_wheel": (-0.25, -1, 0),
        "front_bumper": (2, 0, 0),
        "rear_bumper": (-2, 0, 0),
    }
    assert set(found) == {("base", body) for body in expected}
    for body, pose in expected.items():
        assert found["base", body] == pytest.approx(pose, abs=1e-5)


@pytest.mark.parametrize(
    ("keys", "words"), [({"reference": "nope"}, "nope"), ({"exclude": ["base", "x1"]}, "x1")]
)
def test_mistakes(workshop: Workshop, keys: dict[str, object], words: str) -> None:
    plugin = {"type": "ModelTfPublisher", "name": "tf", **keys}
    with pytest.raises(WorldError, match=words):
        workshop.world({"robot": workshop.model(workshop.circle(0.1), plugins=[plugin])})

"""Names of topics and frames, and points in frames, as Flatland's own tests give them."""

from __future__ import annotations

import copy
import math
import pickle
from pathlib import Path

import pytest

from kit.geometry import Pose
from kit.sim.simulation import load_world
from kit.world.catalogue import find_map
from kit.world.records import Model, SourceLocation


@pytest.mark.parametrize(
    ("namespace", "name", "topic", "frame"),
    [
        ("foo", "bar", "/foo/bar", "foo_bar"),
        ("foo", "/bar", "/bar", "bar"),
        ("", "bar", "/bar", "bar"),
        ("", "/bar", "/bar", "bar"),
    ],
)
def test_names_are_prefixed_by_the_namespace(namespace: str, name: str, topic: str, frame: str) -> None:
    file = Path("m.yaml")
    model = Model("m", namespace, Pose(), file, (), (), (), SourceLocation(file))
    assert (model.topic(name), model.frame(name)) == (topic, frame)


@pytest.mark.parametrize(
    ("frame", "point", "expected"),
    [
        (Pose(2, 1.5, 0), (1, 2), (3, 3.5)),
        (Pose(0, 0, math.pi / 2), (1, 2), (-2, 1)),
        (Pose(1, 0.5, -math.pi), (-1, 1.5), (2, -1)),
    ],
)
def test_points_are_carried_into_a_frame(
    frame: Pose, point: tuple[float, float], expected: tuple[float, float]
) -> None:
    assert frame.transform_point(*point) == pytest.approx(expected, abs=1e-5)


def test_places_are_written_as_editors_read_them() -> None:
    assert str(SourceLocation(Path("worlds/a.yaml"), 3, 7)) == "worlds/a.yaml:3:7"


def test_a_world_can_be_pickled_and_copied() -> None:
    for name in ("turn", "crossing"):  # the second has bodies that move by themselves
        world = load_world(find_map(name).world_file)
        for again in (pickle.loads(pickle.dumps(world)), copy.deepcopy(world)):
            assert repr(again) == repr(world)
            assert dict(again.layer_bits) == dict(world.layer_bits)
            assert [model.pose for model in again.models] == [model.pose for model in world.models]
            with pytest.raises(TypeError):
                again.layer_bits["new"] = 1


def test_a_model_is_as_wide_as_the_shorter_side_of_what_its_footprints_take() -> None:
    world = load_world(find_map("simple").world_file)
    robot = next(model for model in world.models if model.plugins)
    xs, ys = zip(*((x, y) for x, y, _ in robot.outer_points), strict=True)
    assert robot.width == pytest.approx(min(max(xs) - min(xs), max(ys) - min(ys)))
    assert Model("m", "", Pose(), Path("m.yaml"), (), (), (), SourceLocation(Path("m.yaml"))).width == 0.0

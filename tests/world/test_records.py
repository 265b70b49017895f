"""Names of topics and frames, and points in frames, as Flatland's own tests give them."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from kit.geometry import Pose
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

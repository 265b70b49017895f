"""A drive that is told by one process and drawn by another."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from kit.render.drive_playback import MAX_POSES, MAX_WALLS, DrivenPlace, DrivePlayback
from kit.render.scene import Disc

SQUARE = np.array([[0.0, 0, 4, 0], [4, 0, 4, 3], [4, 3, 0, 3], [0, 3, 0, 0]])
HULL = (np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]]),)
PLACE = DrivenPlace(SQUARE, HULL, Disc(3.0, 1.0, 0.2))


def drive(
    poses: list[tuple[float, float, float]], seconds: float = 2.0, case: str = "there"
) -> DrivePlayback:
    return DrivePlayback(case, "hit a wall", np.array(poses, dtype=float)[:, None], seconds, PLACE)


def test_between_two_poses_it_is_on_its_way_and_turns_the_short_way_round() -> None:
    shown = drive([(0, 1, math.radians(170)), (2, 1, math.radians(-170))])
    start, middle, end = (shown.scene_at(time_s).robots[0].pose for time_s in (-1.0, 1.0, 9.0))
    assert (start.x, end.x) == (0, 2)
    assert middle.x == pytest.approx(1.0)
    assert abs(math.cos(middle.theta)) == pytest.approx(1.0)
    assert len(shown.scene_at(0.0).trails[0]) < len(shown.scene_at(2.0).trails[0])
    assert shown.scene_at(2.0).targets == (PLACE.target,)


def test_what_is_told_is_what_is_read() -> None:
    poses = [(0.05 * number, 1.0, 0.02 * number) for number in range(70)]
    told = drive(poses, 7.0).to_text(with_place=True)
    assert "\n" not in told
    found = DrivePlayback.from_text(told)
    assert len(found.poses) == MAX_POSES
    assert (found.case, found.result, found.duration_s) == ("there", "hit a wall", 7.0)
    np.testing.assert_allclose(found.poses[-1, 0], poses[-1], atol=0.02)
    np.testing.assert_allclose(found.place.walls, SQUARE)
    assert found.place.target == PLACE.target


def test_the_place_may_have_been_told_before_with_the_same_case() -> None:
    poses = [(0.0, 1.0, 0.0), (1.0, 1.0, 0.0)]
    earlier = [
        drive(poses, case="back").to_text(with_place=True),
        drive(poses).to_text(with_place=True),
    ]
    later = drive(poses).to_text(with_place=False)
    assert "walls" not in later
    assert len(DrivePlayback.from_text(later, earlier).place.walls) == len(SQUARE)
    with pytest.raises(ValueError, match="not a drive"):
        DrivePlayback.from_text(later, earlier[:1])


def test_a_place_with_too_many_walls_is_not_told() -> None:
    large = DrivenPlace(np.zeros((MAX_WALLS + 1, 4)), HULL, None)
    assert DrivePlayback("there", "", np.zeros((2, 1, 3)), 1.0, large).to_text(with_place=True) == ""


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("poses", []),
        ("poses", [[[0, 0]]]),
        ("poses", [[[0, 0, 10**400]]]),
        ("poses", [[[0, 0, float("nan")]]]),
        ("poses", 3),
        ("walls", [["a", 0, 0, 0]]),
        ("hull", 4),
        ("hull", None),
        ("seconds", "soon"),
        ("target", [1, 2]),
        ("case", None),
    ],
)
def test_a_damaged_text_is_refused_or_read_as_words(key: str, value: object) -> None:
    content = json.loads(drive([(0, 1, 0), (1, 1, 0)]).to_text(with_place=True))
    content[key] = value
    if key == "case":
        assert DrivePlayback.from_text(json.dumps(content)).case == "None"
        return
    with pytest.raises(ValueError, match=r"."):
        DrivePlayback.from_text(json.dumps(content))


def test_words_cannot_control_a_terminal() -> None:
    content = json.loads(drive([(0, 1, 0), (1, 1, 0)]).to_text(with_place=True))
    content["case"] = "a\x1b[31m\n" + "b" * 500
    assert DrivePlayback.from_text(json.dumps(content)).case.startswith("a?[31m bb")
    assert len(DrivePlayback.from_text(json.dumps(content)).case) <= 200


def test_no_text_of_any_kind_breaks_the_reader() -> None:
    for text in ("", "{", "[]", "3", "null", '"a"', "{}", '{"walls":1}', "[" * 5000):
        with pytest.raises(ValueError, match=r"."):
            DrivePlayback.from_text(text)

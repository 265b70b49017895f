"""A drive by hand that is handed in: run again, judged, and no trick of a file's works."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grader.assignment import Assignment
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.confinement import Level
from kit.run.recording import Input, Recording, load_recording, save_recording
from kit.run.scenario import find_scenario
from kit.school.result import CriterionStatus, GradingResult, GradingVerdict
from tests.solutions.drives import AGAIN, STILL, ahead, driven, left

ASSIGNMENT_TEXT = """
title: Forward
kind: drive
submit: drive.npz
level: 0
drive: {place: simple, time: 20}
checks:
  - {check: genuine, points: 1}
  - {check: moves, points: 1, after: genuine, share: {none: 0, full: 1}}
  - {check: bumps, points: 1, after: genuine, share: {none: 1, full: 0}}
"""
DESK = GradingOptions(Level.LIMITED, secret=True)
Edit = Callable[[dict[str, Any]], None]


@pytest.fixture(scope="module")
def assignment(tmp_path_factory: pytest.TempPathFactory) -> Assignment:
    folder = tmp_path_factory.mktemp("forward")
    (folder / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    return read_assignment(folder)


@pytest.fixture(scope="module")
def recording() -> Recording:
    return driven(find_scenario("simple"), [ahead(1.2), STILL])


def handed_in(assignment: Assignment, data: bytes) -> GradingResult:
    return grade(assignment, Submission("ada", "drive.npz", {"drive.npz": data}), DESK)


def as_bytes(recording: Recording, folder: Path) -> bytes:
    save_recording(recording, folder / "made.npz")
    return (folder / "made.npz").read_bytes()


def refused(result: GradingResult) -> str:
    """What is said of a file that cannot be taken."""
    assert result.tests[0].status is CriterionStatus.STUDENT_ERROR
    assert result.points == 0
    said = result.tests[0].rationale
    assert "Traceback" not in said
    assert "/tmp" not in said
    return said


def test_a_true_drive_earns_what_it_drove(
    assignment: Assignment, recording: Recording, tmp_path: Path
) -> None:
    result = handed_in(assignment, as_bytes(recording, tmp_path))
    assert result.verdict is GradingVerdict.PASS
    assert result.points == 3


@pytest.mark.long
def test_the_best_attempt_counts(assignment: Assignment, tmp_path: Path) -> None:
    legs = [ahead(2.9), AGAIN, left(90), ahead(1.1), AGAIN, STILL]
    result = handed_in(assignment, as_bytes(driven(find_scenario("simple"), legs), tmp_path))
    assert result.points == 3
    bumped = handed_in(assignment, as_bytes(driven(find_scenario("simple"), [ahead(3.0)]), tmp_path))
    assert next(test for test in bumped.tests if test.id == "bumps").points == 0


def test_poses_that_were_changed_prove_nothing(
    assignment: Assignment, recording: Recording, tmp_path: Path
) -> None:
    poses = recording.poses + np.linspace(0, 1, recording.ticks)[:, None]
    result = handed_in(assignment, as_bytes(replace(recording, poses=poses), tmp_path))
    assert result.tests[0].status is CriterionStatus.FAIL
    assert result.points == 0


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"place": "maze", "case": "maze"}, "maze"),
        ({"case": "other"}, "other"),
        ({"level": "the-nurse"}, "the-nurse"),
        ({"step_size": 0.02}, "0.02"),
        ({"models": ((0, ("other",)),)}, "models"),
        ({"inputs": (Input(0, "move_model", ("serp", [3.0, 1.9, 0.0])),)}, "keys"),
        ({"inputs": (Input(0, "spawn_model", ("/etc/passwd", "x", "", [0, 0, 0])),)}, "keys"),
        ({"inputs": (Input(0, "delete_model", ("serp",)),)}, "keys"),
        ({"inputs": (Input(0, "accept", ("/odom", "geometry_msgs/msg/Twist", {})),)}, "/odom"),
        ({"inputs": (Input(0, "accept", ("/cmd_vel", "os/system", {})),)}, "accept"),
        ({"inputs": (Input(0, "accept", ("/cmd_vel", "geometry_msgs/msg/Twist", {"linear": 3})),)}, "accept"),
        (
            {
                "inputs": (
                    Input(
                        0, "accept", ("/cmd_vel", "geometry_msgs/msg/Twist", {"linear": {"x": float("nan")}})
                    ),
                )
            },
            "accept",
        ),
        ({"inputs": (Input(0, "accept", ()),)}, ""),
        ({"inputs": (Input(0, "reset", (None,)),) * 100_000}, "more commands"),
    ],
    ids=[
        *("place", "case", "level", "step", "models", "lift", "spawn", "delete"),
        *("topic", "type", "shape", "nan", "nothing", "flood"),
    ],
)
def test_what_no_keys_can_do_is_refused(
    assignment: Assignment, recording: Recording, tmp_path: Path, change: dict[str, Any], word: str
) -> None:
    said = refused(handed_in(assignment, as_bytes(replace(recording, **change), tmp_path)))
    assert word in said


def test_a_long_recording_is_refused(assignment: Assignment, tmp_path: Path) -> None:
    recording = driven(find_scenario("simple"), [STILL])
    ticks = 2100
    long = replace(recording, poses=np.zeros((ticks, 3)), counts=np.ones(ticks, dtype=np.int64), inputs=())
    assert "at most 20 s" in refused(handed_in(assignment, as_bytes(long, tmp_path)))


def _archive(**parts: bytes) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(f"{name}.npy", content)
    return data.getvalue()


def _array(values: Any) -> bytes:
    data = io.BytesIO()
    np.save(data, values, allow_pickle=True)
    return data.getvalue()


def _header(**changes: Any) -> bytes:
    header = {
        "format": 1,
        "place": "simple",
        "case": "simple",
        "seed": 0,
        "step_size": 0.01,
        "models": [[0, ["serp"]]],
        "inputs": [],
    }
    return _array(np.frombuffer(json.dumps(header | changes).encode(), dtype=np.uint8))


class Bad:
    def __reduce__(self) -> tuple[Any, ...]:
        return exec, ("raise SystemExit('ran')",)


CLAIMED = (
    b"\x93NUMPY\x01\x00v\x00"
    + b"{'descr': '<f8', 'fortran_order': False, 'shape': (999999999999, 3), }".ljust(117)
    + b"\n"
)
POSES, COUNTS = _array(np.zeros((5, 3))), _array(np.ones(5, dtype=np.int64))
NASTY = {
    "empty": b"",
    "text": b"not a zip",
    "cut": _archive(header=_header(), poses=POSES, counts=COUNTS)[:-30],
    "missing": _archive(header=_header(), poses=POSES),
    "more": _archive(header=_header(), poses=POSES, counts=COUNTS, extra=POSES),
    "bomb": _archive(header=_header(), poses=_array(np.zeros((4_000_000, 3))), counts=COUNTS),
    "claimed": _archive(header=_header(), poses=CLAIMED, counts=COUNTS),
    "pickle": _archive(header=_header(), poses=_array(np.array([[Bad()]], dtype=object)), counts=COUNTS),
    "dimensions": _archive(header=_header(), poses=_array(np.zeros((5, 3, 1))), counts=COUNTS),
    "json": _archive(
        header=_array(np.frombuffer(b"[" * 100_000, dtype=np.uint8)), poses=POSES, counts=COUNTS
    ),
    "seed": _archive(header=_header(seed=-1), poses=POSES, counts=COUNTS),
    "infinite seed": _archive(header=_header(seed=1e400), poses=POSES, counts=COUNTS),
    "steps": _archive(header=_header(step_size=0), poses=POSES, counts=COUNTS),
    "reset": _archive(header=_header(inputs=[[0, "reset", ["x"]]]), poses=POSES, counts=COUNTS),
    "early": _archive(header=_header(inputs=[[-5, "reset", [{"a": 1}]]]), poses=POSES, counts=COUNTS),
    "counts": _archive(header=_header(), poses=POSES, counts=_array(np.array([5, 0, 0, 0, 0]))),
}


@pytest.mark.parametrize("name", NASTY)
def test_a_file_that_is_no_recording_is_refused_and_harms_nobody(assignment: Assignment, name: str) -> None:
    result = handed_in(assignment, NASTY[name])
    assert result.verdict is GradingVerdict.FAIL
    assert result.points == 0
    assert all(test.status is not CriterionStatus.GRADER_ERROR for test in result.tests)


def test_a_sheet_without_a_place_is_told_so(tmp_path: Path) -> None:
    from kit.world.problems import WorldError

    (tmp_path / "assignment.yaml").write_text(ASSIGNMENT_TEXT.replace("place: simple", "place: simpel"))
    with pytest.raises(WorldError, match="simple"):
        read_assignment(tmp_path)


@pytest.mark.long
def test_the_solutions_are_as_their_script_makes_them(tmp_path: Path) -> None:
    from tests.solutions.drives import FLAG, FOLDER

    place, legs = FLAG["solution"]
    kept = load_recording(FOLDER / "01-drive" / "flag" / "solution.npz")
    assert np.abs(driven(find_scenario(place), legs).poses - kept.poses).max() < 1e-6

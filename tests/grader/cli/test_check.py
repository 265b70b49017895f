"""The worst episode kept in a file: a recording that moves, and runs again to the bit."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from grader.__main__ import main
from grader.kinds.reward.exploit_recording import TICKS_PER_MOVE
from kit.run.recording import load_recording, rerun
from kit.run.scenario import find_scenario
from kit.school.lessons.reading import lessons_folder
from tests.grader.conftest import FORWARD, QUICK, TEMPLATES, write_assignment

KIT_MAPS = Path(str(find_scenario("turn").world.file)).parents[1]


def checked(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(main, ["check", *arguments])
    assert not done.exception or isinstance(done.exception, SystemExit), done.exc_info
    return done.exit_code, done.output


@pytest.mark.long
def test_a_drive_on_a_map_of_the_kit(tmp_path: Path) -> None:
    folder, file, out = write_assignment(tmp_path / "q"), tmp_path / "ada.py", tmp_path / "worst.npz"
    file.write_text(FORWARD)
    code, text = checked(str(file), "--assignment", str(folder))
    assert (code, "add --replay" in text) == (1, True)
    code, text = checked(str(file), "--assignment", str(folder), "--replay", str(out))
    assert f"To watch it: kit replay {out}\n" in text
    kept = load_recording(out)
    assert np.array_equal(rerun(kept, find_scenario(kept.place, kept.case).world).poses, kept.poses)


def test_a_drive_in_a_world_of_the_assignments_own(tmp_path: Path) -> None:
    folder = tmp_path / "q"
    shutil.copytree(KIT_MAPS / "turn", folder / "turn-too")
    shutil.copytree(KIT_MAPS / "robots", folder / "robots")
    write_assignment(folder, QUICK.replace("place: turn", "place: turn-too/world.yaml, target: [2, 3]"))
    file, out = tmp_path / "ada.py", tmp_path / "worst.npz"
    file.write_text(FORWARD)
    _, text = checked(str(file), "--assignment", str(folder), "--replay", str(out))
    assert f"kit replay {out} --root {folder}" in text
    kept = load_recording(out)
    place = find_scenario(kept.place, kept.case, folder)
    assert np.array_equal(rerun(kept, place.world).poses, kept.poses)


@pytest.mark.long
@pytest.mark.parametrize("wrong", sorted((TEMPLATES / "reward" / "wrong").glob("*planned*.py"), key=str))
def test_the_exploit_of_a_reward(tmp_path: Path, wrong: Path) -> None:
    """It moves through the map, is never far from where it was, and never comes to the target."""
    out = tmp_path / "exploit.npz"
    _, text = checked(str(wrong), "--assignment", str(TEMPLATES / "reward"), "--replay", str(out))
    assert "To watch it" in text
    kept = load_recording(out)
    place = find_scenario(kept.place)
    assert np.array_equal(rerun(kept, place.world).poses, kept.poses)
    assert kept.ticks >= TICKS_PER_MOVE
    way, (target,) = kept.track("robot"), np.unique(kept.track("target"), axis=0)
    assert np.hypot(*np.diff(way[:, :2], axis=0).T).max() < 0.02
    assert np.hypot(*(way[:, :2] - target[:2]).T).min() > 0.1
    walls = place.world.wall_segments
    assert (way[:, :2] > walls[:, :2].min(axis=0)).all()
    assert (way[:, :2] < walls[:, 2:].max(axis=0)).all()


@pytest.mark.long
def test_what_went_well_leaves_no_replay(tmp_path: Path) -> None:
    out = tmp_path / "worst.npz"
    solution = TEMPLATES / "reward" / "solution.py"
    code, text = checked(str(solution), "--assignment", str(TEMPLATES / "reward"), "--replay", str(out))
    assert (code, out.exists()) == (0, False)
    assert "No episode went wrong" in text


CHECK_AND_LIST_MODULES = """
import contextlib, io, sys
from grader.__main__ import main

with contextlib.redirect_stdout(io.StringIO()):
    try:
        main(["check", sys.argv[1], "--assignment", sys.argv[2], "--replay", sys.argv[3], "--level", "0"])
    except SystemExit as ended:
        code = ended.code
print(code, *sys.modules)
"""


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("exercise", "file"), [("01-drive/readout", "readout.yaml"), ("05-world-files/to-scale", "world.yaml")]
)
def test_a_slip_in_yaml_loads_no_simulator(exercise: str, file: str, tmp_path: Path) -> None:
    """It costs a student half a second only if nothing slow is imported for it."""
    (tmp_path / file).write_text("other: [1, 2\n")
    code, modules = _checked_with_modules(tmp_path / file, lessons_folder() / exercise)
    assert code == 1
    assert not {"numpy", "pymunk", "PIL", "kit.sim"} & modules


@pytest.mark.long
def test_a_drive_loads_nothing_of_the_other_kinds(tmp_path: Path) -> None:
    file = tmp_path / "ada.py"
    file.write_text(FORWARD)
    code, modules = _checked_with_modules(file, write_assignment(tmp_path / "q"))
    assert code == 1
    assert (tmp_path / "worst.npz").exists()
    assert "kit.run.recording" in modules
    assert not {
        each for each in modules if each.startswith(("gymnasium", "kit.learning", "grader.kinds.reward"))
    }


def _checked_with_modules(file: Path, assignment: Path) -> tuple[int, set[str]]:
    """Returns the exit code of a check that saves a replay beside the file, and the modules that it has loaded."""
    words = [file, assignment, file.with_name("worst.npz")]
    done = subprocess.run(
        [sys.executable, "-c", CHECK_AND_LIST_MODULES, *map(str, words)],
        capture_output=True,
        text=True,
        check=True,
    )
    code, *modules = done.stdout.split()
    return int(code), set(modules)


@pytest.mark.parametrize("format_name", ["text", "junit", "annotations"])
def test_nothing_tells_how_a_criterion_went_that_is_shown_later(format_name: str, tmp_path: Path) -> None:
    """Neither the exit code nor the picture of the worst episode."""
    sheet = QUICK[: QUICK.index("  - {check: reached")].replace("after: runs", "visibility: hidden")
    folder = write_assignment(tmp_path / "quick", sheet)
    work = tmp_path / "controller.py"
    said = []
    for speed in ("0.3", "0.0"):
        work.write_text(FORWARD.replace("SPEED = 0.3", f"SPEED = {speed}"))
        arguments = ["--assignment", str(folder), "--level", "0", "--format", format_name]
        arguments += ["--for-student"] * (format_name == "text")
        code, text = checked(str(work), *arguments)
        said.append((code, re.sub(r"(time|timestamp|value)=\"[^\"]*\"|[0-9a-f-]{12,}", "", text)))
    assert said[0] == said[1]
    assert said[0][0] == 0

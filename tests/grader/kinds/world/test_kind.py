"""A world that is handed in: what its checks find, and what a huge or hostile one can do."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from grader.check import NoParams
from grader.evidence.contract import EvidenceRecord
from grader.grading import GradingOptions, grade
from grader.kinds.world.checks import CHECKS, MAX_FAULTS_SHOWN, NAMES_NEEDING_RUN, explain, join_faults
from grader.kinds.world.facts import RunFacts, WorldFacts, WorldRunSpec
from grader.kinds.world.faults import WorldContents, WorldRun
from grader.kinds.world.world_process import WorldProcess
from grader.kinds.world.world_reading import read_world_facts
from grader.kinds.world.world_run import run_world, search_path
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.host.failure import FailureKind, StudentCodeError
from kit.host.sandbox import landlock
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingVerdict
from kit.world.problems import WorldError
from tests.grader.conftest import TEMPLATES

TEMPLATE = TEMPLATES / "world"
DESK = GradingOptions(Level.LIMITED, secret=True)
DRIVE = WorldRunSpec("room", 1, 20.0, str(TEMPLATE / "driver.py"), "", (3.0, 1.5), 0.2, True)
REST = replace(DRIVE, driver="", target=None, time_s=3.0)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The template's solution, to be changed."""
    return Path(shutil.copytree(TEMPLATE / "solution", tmp_path / "handed-in"))


def change(folder: Path, name: str, old: str, new: str) -> None:
    text = (folder / name).read_text()
    assert old in text
    (folder / name).write_text(text.replace(old, new))


def seen(folder: Path, spec: WorldRunSpec | None = None) -> WorldContents | WorldRun:
    facts, world = read_world_facts(folder / "world.yaml")
    if spec is None:
        return WorldContents(facts)
    assert world is not None, facts.problems
    return WorldRun(facts, run_world(world, spec), spec.target is not None)


def judged(found: WorldContents | WorldRun, name: str, **params: Any) -> tuple[bool, str]:
    """Whether a check is passed with these params, and what is said of it."""
    check = CHECKS[name]
    given = check.params(**params)
    share = check.anchors.share(check.measure(EvidenceRecord(found), given))
    return share == 1.0, explain(found, name, given)


@pytest.mark.parametrize(
    ("file", "old", "new", "check", "params", "word"),
    [
        ("room.yaml", "scale: 0.1", "scale: 1", "walls", {"width": 4.0}, "40 m wide"),
        ("room.yaml", "[0, 0, 0]", "[1, 0, 0]", "walls", {"left": 0.0}, "left side is 1 m"),
        ("room.yaml", "0.1", "0.1", "walls", {"map": "hall"}, "hall"),
        ("world.yaml", "[1.0, 1.0, 0]", "[1.0, 2.0, 0]", "stands", {"x": 1.0, "y": 1.0}, "[1, 2]"),
        ("world.yaml", "robot.model", "robot.model", "has", {"models": ("cart",)}, '"cart"'),
        ("robot.model.yaml", "DiffDrive", "TricycleDrive", "loads", {}, "robot.model.yaml:"),
        ("robot.model.yaml", "layers: [seen]", "layers: [seeen]", "loads", {}, 'did you mean "seen"'),
        ("robot.model.yaml", "radius: 0.1", "radius: 0.2", "body", {"body": "base", "width": 0.2}, "0.4 m"),
        ("robot.model.yaml", "density: 1,", "density: 1, sensor: true,", "body", {"sensor": "no"}, "sensor"),
        ("robot.model.yaml", "base", "base", "joint", {"a": "base", "b": "wheel"}, "no joint"),
        ("robot.model.yaml", "0.06981317", "0.07", "laser", {"rays": 91, "last": 3.1415927}, "last ray"),
        ("robot.model.yaml", "body: base}", "body: base, twist_sub: go}", "subscribes", {"topics": ("/cmd_vel",)}, "/go"),
        ("robot.model.yaml", "lidar", "lidar", "publishes", {"topics": ("/cmd_vel",)}, "only subscribed"),
        ("robot.model.yaml", "lidar", "lidar", "publishes", {"topics": ("/scan std_msgs/msg/Bool",)}, "LaserScan"),
        ("robot.model.yaml", "layers: [solid]", "layers: []", "collisions", {"collide": ("room - robot",)}, "no layer"),
        ("robot.model.yaml", "[solid]", "[solid]", "collisions", {}, "and should not"),
        ("robot.model.yaml", "[solid]", "[solid]", "collisions", {"collide": ("cart - robot",)}, '"cart"'),
        ("robot.model.yaml", "[seen]", "[]", "sights", {"sees": ("robot/lidar: room",)}, "does not see room"),
        ("robot.model.yaml", "[seen]", "[seen]", "sights", {"sees": ("robot/lidar:",)}, "and should not"),
        ("robot.model.yaml", "[seen]", "[seen]", "sights", {"sees": ("robot/eye: room",)}, "no laser"),
        ("robot.model.yaml", "[seen]", "[solid]", "sights", {"looks_at": ("robot/lidar: seen",)}, "looks at solid, not at seen"),
        ("robot.model.yaml", "[seen]", "[seen]", "sights", {"looks_at": ("robot/eye: seen",)}, "no laser"),
    ],
)  # fmt: skip
def test_a_fault_is_found_and_told(
    folder: Path, file: str, old: str, new: str, check: str, params: dict[str, Any], word: str
) -> None:
    change(folder, file, old, new)
    passed, said = judged(seen(folder), check, **params)
    assert not passed
    assert word in said
    assert str(folder) not in said


def test_what_is_right_passes(folder: Path) -> None:
    found = seen(folder)
    assert judged(found, "loads") == (True, "")
    assert judged(found, "walls", map="room", left=0.0, bottom=0.0, width=4.0, height=3.0) == (True, "")
    assert judged(found, "collisions", collide=("robot - room",)) == (True, "")
    assert judged(found, "sights", sees=("robot/lidar: room",)) == (True, "")
    assert judged(found, "sights", looks_at=("robot/lidar: seen",)) == (True, "")
    assert judged(found, "laser", rays=91, first=-3.14159, last=3.14159, range=5.0, body="base")[0]
    assert judged(found, "publishes", topics=("/scan sensor_msgs/msg/LaserScan",))[0]
    assert judged(found, "subscribes", topics=("/cmd_vel geometry_msgs/msg/Twist",))[0]
    assert isinstance(found, WorldContents)
    assert "#" in found.world.picture


def test_a_world_that_does_not_load_earns_nothing_and_breaks_nothing(folder: Path) -> None:
    (folder / "world.yaml").write_text("layers: [")
    found = seen(folder)
    for name, check in CHECKS.items():
        given = check.params()
        if name not in NAMES_NEEDING_RUN:
            assert not check.anchors.share(check.measure(EvidenceRecord(found), given)) > 0
        assert explain(found, name, given)


@pytest.mark.long
def test_a_drive_is_run_and_measured(folder: Path) -> None:
    found = seen(folder, DRIVE)
    assert judged(found, "drives") == (True, "")
    assert judged(found, "bumps")[0]
    assert not judged(found, "stopped")[0]
    assert judged(found, "reachable")[0]
    assert judged(found, "closed")[0]
    assert judged(found, "rate", topic="/scan", rate=10.0)[0]
    assert not judged(found, "rate", topic="/scan", rate=5.0)[0]
    assert not judged(found, "rate", topic="/odd", rate=5.0)[0]


@pytest.mark.long
def test_the_same_run_twice_is_the_same(folder: Path) -> None:
    assert seen(folder, DRIVE) == seen(folder, DRIVE)


def test_noise_is_measured(folder: Path) -> None:
    change(folder, "robot.model.yaml", "range: 5", "range: 5\n    noise_std_dev: 0.05")
    change(folder, "robot.model.yaml", "body: base}", "body: base, odom_pose_noise: [0.0009, 0.0009, 0]}")
    found = seen(folder, replace(REST, time_s=10.0))
    assert judged(found, "noise", topic="/scan", deviation=0.05)[0]
    assert judged(found, "noise", topic="/odometry/filtered", deviation=0.03)[0]
    assert not judged(found, "noise", topic="/scan", deviation=0.0025)[0]


def test_a_gap_in_the_walls_is_found(folder: Path) -> None:
    change(folder, "room.dat", "0 30 0 0\n", "0 30 0 12\n")
    assert not judged(seen(folder, REST), "closed")[0]


@pytest.mark.long
def test_a_wall_in_the_way_is_found(folder: Path) -> None:
    change(folder, "room.dat", "0 30 0 0\n", "0 30 0 0\n20 0 20 30\n")
    found = seen(folder, replace(DRIVE, time_s=8.0))
    assert judged(found, "stopped")[0]
    assert not judged(found, "bumps")[0]
    assert not judged(found, "reachable")[0]
    passed, said = judged(found, "drives")
    assert (passed, "away" in said) == (False, True)


@pytest.mark.long
def test_a_robot_that_moves_by_itself_is_not_driven(folder: Path) -> None:
    """It arrives all the same, and nothing but the drive without a driver tells the two apart."""
    shutil.copytree(TEMPLATE / "wrong" / "drives__moves_by_itself", folder, dirs_exist_ok=True)
    found = seen(folder, DRIVE)
    assert isinstance(found, WorldRun)
    assert found.run.reached_s is not None
    passed, said = judged(found, "drives")
    assert (passed, "nobody drives it" in said) == (False, True)


def test_nobody_to_drive_is_said_and_costs_the_run(folder: Path) -> None:
    change(
        folder, "robot.model.yaml", "{type: DiffDrive, name: drive, body: base}", "{type: Bumper, name: bump}"
    )
    passed, said = judged(seen(folder, DRIVE), "drives")
    assert (passed, "drive" in said) == (False, True)


def test_joints_that_come_apart_are_found(folder: Path) -> None:
    """A weld whose ends lie 1 m apart, on two bodies that cannot move."""
    text = (folder / "robot.model.yaml").read_text()
    body = "  - name: {}\n    type: static\n    pose: [{}, 0, 0]\n    footprints: []\n"
    joint = "joints:\n  - {name: bar, type: weld, bodies: [{name: one, anchor: [0, 0]}, {name: two, anchor: [0, 0]}]}\n"
    text = text.replace("\nplugins:", f"{body.format('one', 0)}{body.format('two', 1)}{joint}\nplugins:")
    (folder / "robot.model.yaml").write_text(text)
    passed, said = judged(seen(folder, REST), "together")
    assert (passed, "1000 mm" in said) == (False, True)


@pytest.mark.parametrize(
    ("walls", "radius", "way", "closed"),
    [
        ([(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)], 0.1, True, True),
        ([(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0), (2, 0, 2, 4)], 0.1, False, True),
        ([(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0), (2, 0, 2, 3.7)], 0.1, True, True),
        ([(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0), (2, 0, 2, 3.7)], 0.2, False, True),
        ([(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4)], 0.1, True, False),
        ([], 0.1, True, False),
    ],
    ids=["room", "divided", "door", "narrow door", "open", "nothing"],
)
def test_a_way_is_found_where_there_is_one(
    walls: list[tuple[float, ...]], radius: float, way: bool, closed: bool
) -> None:
    segments = np.array(walls, dtype=np.float64).reshape(-1, 4)
    assert search_path(segments, (1.0, 1.0), (3.0, 1.0), radius) == (way, closed)


def test_facts_travel_as_json(folder: Path) -> None:
    import json

    facts, world = read_world_facts(folder / "world.yaml")
    assert world is not None
    assert WorldFacts.from_json(json.loads(json.dumps(asdict(facts)))) == facts
    told = run_world(world, REST)
    assert RunFacts.from_json(json.loads(json.dumps(asdict(told)))) == told


# What a stranger may hand in


def test_a_program_in_a_world_is_not_run(folder: Path) -> None:
    change(folder, "world.yaml", "[1.0, 1.0, 0]", "$eval return os.exit(1)")
    assert not judged(seen(folder), "loads")[0]


def test_nothing_outside_the_folder_is_read(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "room.dat", tmp_path / "secret.dat")
    change(folder, "room.yaml", "data: room.dat", "data: ../secret.dat")
    passed, said = judged(seen(folder), "loads")
    assert (passed, "outside the world's folder" in said) == (False, True)
    assert str(tmp_path) not in said


def test_a_drawing_in_the_place_of_a_map_file_is_explained(folder: Path) -> None:
    change(folder, "world.yaml", "map: room.yaml", "map: room.dat")
    assert "data: room.dat" in judged(seen(folder), "loads")[1]


@pytest.mark.long
def test_a_picture_too_large_is_refused(folder: Path) -> None:
    Image.new("1", (20_000, 20_000)).save(folder / "huge.png")
    (folder / "room.yaml").write_text(
        "image: huge.png\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\n"
    )
    assert not judged(seen(folder), "loads")[0]


BREAK_OUT = """
import os, signal, socket, sys
from pathlib import Path
from grader.kinds.world import child

file, scratch, secret, driver, is_confined = sys.argv[1:]
if is_confined:
    child.confine_before_reading(Path(file), scratch, [driver])
elsewhere = Path(secret).with_name("mine")
attempts = {
    "reads the world": lambda: open(file).read(),
    "reads the driver": lambda: open(driver).read(),
    "writes to its folder": lambda: Path(scratch, "a").write_text("a"),
    "reads a secret": lambda: open(secret).read(),
    "reads /etc/passwd": lambda: open("/etc/passwd").read(),
    "reads its parent's environment": lambda: open(f"/proc/{os.getppid()}/environ", "rb").read(),
    "writes elsewhere": lambda: elsewhere.write_text("mine"),
    "writes into the world": lambda: open(file, "a").write(" "),
    "opens a socket": socket.socket,
    "signals the process above": lambda: os.kill(os.getppid(), signal.SIGCONT),
}
for name, attempt in attempts.items():
    try:
        attempt()
    except OSError as error:
        continue
    print(name)
"""
ALLOWED = ["reads the world", "reads the driver", "writes to its folder"]


@pytest.mark.long
def test_what_reads_a_world_could_do_no_harm(folder: Path, tmp_path: Path) -> None:
    """If a world made its reader run other code, that code would find no secret, no network and no other process."""
    if highest_level_up_to(Level.FILTERED) < Level.FILTERED:
        pytest.skip("this machine has no level 1")
    secret = tmp_path / "sheet" / "secret.yaml"
    driver = Path(shutil.copytree(TEMPLATE, secret.parent)) / "driver.py"
    secret.write_text("seeds: 4711")
    scratch = tmp_path / "scratch"
    scratch.mkdir()

    def managed(is_confined: str) -> list[str]:
        words = [str(folder / "world.yaml"), str(scratch), str(secret), str(driver), is_confined]
        done = subprocess.run(
            [sys.executable, "-P", "-c", BREAK_OUT, *words],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.splitlines()

    assert len(managed("")) == 10  # without confinement all of it works
    kept = ["signals the process above"] if landlock.abi() < landlock.SCOPES[0] else []
    assert managed("confined") == [*ALLOWED, *kept]


@pytest.mark.long
def test_a_confined_world_is_read_and_run_as_any(folder: Path) -> None:
    if highest_level_up_to(Level.FILTERED) < Level.FILTERED:
        pytest.skip("this machine has no level 1")
    found = []
    for level in (Level.LIMITED, Level.FILTERED):
        with WorldProcess(folder / "world.yaml", level=level, drivers=[DRIVE.driver]) as process:
            found.append((process.read_world(), process.run(DRIVE, 60.0)))
    assert found[0] == found[1]
    assert found[0][1].reached_s is not None


def test_a_world_too_slow_to_read_is_ended(folder: Path) -> None:
    began = time.monotonic()
    process = WorldProcess(folder / "world.yaml")
    with pytest.raises(StudentCodeError) as caught:
        process.read_world(0.01)
    assert caught.value.failure.kind is FailureKind.TIMEOUT
    assert time.monotonic() - began < 20
    assert process._child.poll() is not None


@pytest.mark.long
def test_a_world_that_needs_too_much_memory_is_ended(folder: Path) -> None:
    Image.fromarray(np.random.default_rng(1).integers(0, 255, (1000, 1000), np.uint8)).save(
        folder / "noise.png"
    )
    (folder / "room.yaml").write_text(
        "image: noise.png\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\n"
    )
    with (
        WorldProcess(folder / "world.yaml", memory=1 << 26) as process,
        pytest.raises(StudentCodeError) as caught,
    ):
        process.read_world()
    assert caught.value.failure.kind is FailureKind.MEMORY


@pytest.mark.long
def test_a_run_too_slow_is_ended_and_the_rest_still_counts(folder: Path, tmp_path: Path) -> None:
    sheet = Path(shutil.copytree(TEMPLATE, tmp_path / "sheet"))
    (sheet / "secret.yaml").unlink()
    change(sheet, "assignment.yaml", "level: 1", "level: 0\nbudget: {total: 1}")
    eyes = "".join(
        f"  - {{type: Laser, name: eye{n}, body: base, range: 9, topic: eye{n}, always_publish: true,"
        " angle: {min: 0, max: 6, increment: 0.0007}}\n"
        for n in range(60)
    )
    (folder / "robot.model.yaml").write_text((folder / "robot.model.yaml").read_text() + eyes)
    result = grade(
        read_assignment(sheet), read_submission(folder, "world.yaml"), GradingOptions(Level.LIMITED)
    )
    status = {test.id: test.status for test in result.tests}
    assert status == {
        "loads": CriterionStatus.PASS,
        "walls": CriterionStatus.PASS,
        "closed": CriterionStatus.TIMEOUT,
        "collisions": CriterionStatus.PASS,
        "sights": CriterionStatus.PASS,
        "drives": CriterionStatus.TIMEOUT,
    }
    told = {test.id: test.rationale for test in result.tests}
    assert "too many walls, rays or bodies" in told["closed"]  # which the other names


@pytest.mark.long
def test_the_world_file_alone_is_told_what_is_missing(folder: Path) -> None:
    result = grade(
        read_assignment(TEMPLATE),
        read_submission(folder / "world.yaml", "world.yaml"),
        replace(DESK, level=Level.FILTERED),
    )
    assert result.verdict is GradingVerdict.FAIL
    assert "room.yaml" in result.tests[0].rationale


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ("driver: driver.py", "driver: drivr.py", "drivr.py"),
        ("driver: driver.py", "driver: random_wolk", "random_walk"),
        ("time: 30", "time: 1000", "time"),
        ("seeds: [1]", "seeds: [1, 1]", "twice"),
        ("map: room,", "mapp: room,", "mapp"),
        ("check: drives", "check: dives", "drives"),
    ],
)
def test_a_teachers_mistake_has_its_place(tmp_path: Path, old: str, new: str, word: str) -> None:
    sheet = Path(shutil.copytree(TEMPLATE, tmp_path / "sheet"))
    change(sheet, "assignment.yaml", old, new)
    with pytest.raises(WorldError, match=word):
        read_assignment(sheet)


def test_every_check_says_what_is_wrong() -> None:
    assert {name for name, check in CHECKS.items() if check.faults is None} == {"loads", "bumps", "stopped"}
    assert all(check.feedback for check in CHECKS.values())
    assert CHECKS["loads"].params is NoParams


def test_of_many_faults_the_first_are_told() -> None:
    faults = [f"fault {number}" for number in range(MAX_FAULTS_SHOWN + 1)]
    assert join_faults(faults[:-1]) == "; ".join(faults[:-1]) + "."
    assert join_faults(faults) == "; ".join(faults[:-1]) + "; and 1 more."

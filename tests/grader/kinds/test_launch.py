"""Launch files that are handed in: what is looked at, and what a hostile one can and cannot do."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from grader.assignment import Assignment
from grader.grading import GradingOptions, grade
from grader.kinds.launch.launch_record import MAX_PROGRAMS, MAX_STRIDE, _driven_distance, offered_truths
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.launch.launch_file_process import LaunchTarget
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from kit.world.problems import WorldError
from tests.grader.conftest import LOCKS

LESSON = Path(__file__).parents[3] / "lessons" / "04-launch-files" / "driver"
SOLUTION = (
    Path(__file__).parents[2] / "solutions" / "04-launch-files" / "driver" / "solution.py"
).read_text()
DESK = GradingOptions(Level.LIMITED, secret=True)

HEAD = """
from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        %s
    ])
"""
WORLD = """Node(package='flatland_server', executable='flatland_server', name='flatland_server',
    parameters=[{'world_path': %r}]),"""


@pytest.fixture(scope="module")
def assignment() -> Assignment:
    return read_assignment(LESSON)


def handed_in(assignment: Assignment, text: str, options: GradingOptions = DESK) -> GradingResult:
    name = assignment.submit
    return grade(assignment, Submission("ada", name, {name: text.encode()}), options)


@pytest.mark.long
def test_a_right_one_earns_everything(assignment: Assignment) -> None:
    assert handed_in(assignment, SOLUTION).verdict is GradingVerdict.PASS


@pytest.mark.long
@LOCKS
def test_a_right_one_earns_everything_wherever_the_grader_was_started(
    assignment: Assignment, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At level 2 the grader's working folder does not exist for the programs."""
    monkeypatch.chdir(tmp_path)
    options = replace(DESK, level=highest_level_up_to(Level.SEPARATE))
    assert handed_in(assignment, SOLUTION, options).verdict is GradingVerdict.PASS


@pytest.mark.long
@LOCKS
def test_a_right_one_earns_everything_locked_in(assignment: Assignment) -> None:
    result = handed_in(assignment, SOLUTION, GradingOptions(Level.FILTERED, secret=True))
    assert [test.rationale for test in result.tests if test.status is not CriterionStatus.PASS] == []


@pytest.mark.long
def test_what_is_missing_is_named_with_what_is_there_instead(assignment: Assignment) -> None:
    result = handed_in(assignment, SOLUTION.replace('name="driver"', 'name="pilot"'))
    assert "/pilot" in result.tests[0].rationale


@pytest.mark.long
@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("def generate_launch_description(:\n", "SyntaxError"),
        ("x = 1\n", "generate_launch_description"),
        ("import nothing_like_that\n", "nothing_like_that"),
        (HEAD % "1 / 0", "ZeroDivisionError"),
        (HEAD % "Node(package='convoy', executable='nobody')", "nobody"),
        (HEAD % "Node(package='nowhere', executable='cruise')", "nowhere"),
        (HEAD % "ExecuteProcess(cmd=['touch', '/tmp/was_here'])", "not started here"),
        (HEAD % "ExecuteProcess(cmd=['python3', 'world/x.py'])", "not started here"),
        (HEAD % "ExecuteProcess(cmd=['ros2', 'topic', 'list'], shell=True)", "not started here"),
        (HEAD % (WORLD % "/etc/passwd"), "one of the package's"),
        (HEAD % (WORLD % "../../../etc/hosts"), "one of the package's"),
        (
            HEAD
            % f"*[Node(package='convoy', executable='cruise', name=f'n{{i}}') for i in range({MAX_PROGRAMS + 1})]",
            f"more than {MAX_PROGRAMS}",
        ),
    ],
    ids=[
        *("syntax", "empty", "import", "raises", "program", "package", "command", "python", "shell"),
        *("world", "outside", "many"),
    ],
)
def test_a_wrong_or_hostile_one_is_told_why(assignment: Assignment, text: str, word: str) -> None:
    result = handed_in(assignment, text)
    assert result.points == 0
    assert result.tests[0].status is CriterionStatus.STUDENT_ERROR
    assert word in result.tests[0].rationale
    assert "/launch-" not in result.tests[0].rationale


@pytest.mark.long
def test_so_many_programs_are_started(assignment: Assignment) -> None:
    text = (
        HEAD
        % f"*[Node(package='convoy', executable='cruise', name=f'n{{i}}') for i in range({MAX_PROGRAMS})]"
    )
    result = handed_in(assignment, text)
    assert result.tests[0].status is CriterionStatus.FAIL  # judged, and found to be something else
    assert "programs" not in result.tests[0].rationale


def test_a_jump_is_no_driven_distance() -> None:
    def distance(stride: float) -> float:
        return _driven_distance(np.array([(0.0, 0.0, 0.0), (0.05, 0.0, 0.0), (0.05, stride, 0.0)]))

    assert distance(MAX_STRIDE) == pytest.approx(0.05 + MAX_STRIDE)
    assert distance(math.nextafter(MAX_STRIDE, 1.0)) == pytest.approx(0.05)


@pytest.mark.long
def test_one_that_never_ends_is_ended(assignment: Assignment) -> None:
    quick = replace(assignment, limits=replace(assignment.limits, start_s=3.0))
    result = handed_in(quick, "while True:\n    pass\n")
    assert result.tests[0].status is CriterionStatus.TIMEOUT


def test_a_package_outside_the_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "inside").mkdir()
    sheet = (LESSON / "assignment.yaml").read_text().replace("package: starter", "package: ../outside")
    (tmp_path / "inside" / "assignment.yaml").write_text(sheet)
    with pytest.raises(WorldError, match=r"package\.xml"):
        read_assignment(tmp_path / "inside")


@pytest.mark.long
@LOCKS
def test_a_launch_file_cannot_read_what_is_not_its_own(assignment: Assignment, tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("42")
    text = HEAD % f"LogInfo(msg=open({str(secret)!r}).read())"
    result = handed_in(assignment, text, GradingOptions(Level.FILTERED, secret=True))
    assert result.points == 0
    assert "PermissionError" in result.tests[0].rationale


def test_truths_of_the_world_are_offered_only_where_a_program_of_the_package_names_them(
    tmp_path: Path,
) -> None:
    launch_file, program = tmp_path / "work.launch.py", tmp_path / "driver.py"
    launch_file.write_text("remappings=[('odom', 'odometry/ground_truth')]")
    program.write_text("self.create_subscription(Odometry, 'odom', self.go, 10)")
    target = LaunchTarget(launch_file, tmp_path, (tmp_path,))
    assert offered_truths(target) == frozenset()
    program.write_text("self.create_subscription(Odometry, 'odometry/ground_truth', self.go, 10)")
    assert offered_truths(target) is None


REWRITES_THE_PACKAGE = """
from pathlib import Path
from ament_index_python.packages import get_package_share_directory
folder = Path(get_package_share_directory(%r))
assert folder.joinpath("package.xml").is_file()
for file in folder.rglob("*.py"):
    file.write_text("raise SystemExit('rewritten')")
folder.joinpath("rclpy.py").write_text("raise SystemExit('in the way')")
"""


@pytest.mark.long
def test_what_it_writes_into_the_package_changes_no_program(assignment: Assignment) -> None:
    """At level 0, where it can write there; the programs that it starts are the teacher's all the same."""
    name = ElementTree.parse(assignment.task.package / "package.xml").findtext("name")
    result = handed_in(assignment, REWRITES_THE_PACKAGE % name + SOLUTION)
    assert [test.rationale for test in result.tests if test.status is not CriterionStatus.PASS] == []

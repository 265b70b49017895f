"""What the process of a launch file answers is checked against what was asked of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from kit.host.failure import FailureKind, StudentCodeError
from kit.launch.launch_bounds import LaunchBounds
from kit.launch.launch_file_process import LIMITS, LaunchFileProcess, LaunchTarget, declared_arguments
from tests.fuzz.frames import HEAR, LAUNCH_PROGRAM, packed, scripted

CONFINED = [HEAR, packed(["confined", 0]), HEAR]


@pytest.fixture
def launch_file(tmp_path: Path) -> Path:
    file = tmp_path / "drive.launch.py"
    file.write_text(LAUNCH_PROGRAM)
    return file


@pytest.mark.parametrize("answers", [[["ended", 0, []]], [["reply", 0, None, []], ["ended", 1, []]]])
def test_a_launch_file_that_runs_cannot_say_that_it_was_only_described(
    launch_file: Path, answers: list[list[object]]
) -> None:
    script = [*CONFINED, packed(answers[0]), *(step for each in answers[1:] for step in (HEAR, packed(each)))]
    with scripted(script):
        launch = LaunchFileProcess(launch_file, launch_file.parent, [], {})
    if len(answers) > 1:
        launch.start()
    with pytest.raises(StudentCodeError) as caught:
        launch.advance(1, []) if len(answers) > 1 else launch.start()
    launch.close()
    assert caught.value.failure.kind is FailureKind.PROTOCOL


def test_a_launch_file_that_is_described_cannot_run(launch_file: Path) -> None:
    with (
        scripted([*CONFINED, packed(["reply", 0, None, []])]),
        pytest.raises(StudentCodeError) as caught,
    ):
        declared_arguments(LaunchTarget(launch_file, launch_file.parent, ()))
    assert caught.value.failure.kind is FailureKind.PROTOCOL


def stopped_at(file: Path, start_s: float) -> str:
    """The file and line that the failure of a launch file names."""
    bounds = LaunchBounds(file_limits=replace(LIMITS, start_s=start_s))
    launch = LaunchFileProcess(file, file.parent, [], {}, bounds)
    with pytest.raises(StudentCodeError) as caught:
        launch.start()
    launch.close()
    failure = caught.value.failure
    return f"{failure.file}:{failure.line}"


@pytest.mark.long
def test_an_expression_that_never_ends_is_told_by_its_line(tmp_path: Path) -> None:
    file = tmp_path / "power.launch.xml"
    file.write_text("""<launch>\n<let name="x" value="$(eval '9**9**9**9')"/>\n</launch>""")
    assert stopped_at(file, 2.0) == "power.launch.xml:2"


DEEP = {
    "a function": ("def f():\n    f()\ndef generate_launch_description():\n    f()\n", 2),
    "a list": (
        "def generate_launch_description():\n    found = []\n    found.append(found)\n    return LaunchDescription(found)\n",
        4,
    ),
    "a text": (
        ("def generate_launch_description():\n    text = 'a'\n    for _ in range(2000):\n"
        "        text = EnvironmentVariable('NO', default_value=text)\n    return LaunchDescription([LogInfo(msg=text)])\n"),
        5,
    ),
    "actions": (
        ("def generate_launch_description():\n    inner = LogInfo(msg='x')\n    for _ in range(2000):\n"
        "        inner = GroupAction([inner])\n    return LaunchDescription([inner])\n"),
        4,
    ),
    "a number": ("def generate_launch_description():\n    return LaunchDescription([\n    LogInfo(msg=N(text='1'))])\n", 0),
}  # fmt: skip
HEAD = (
    "from launch import *; from launch.actions import *; from launch.substitutions import *\n"
    "N = type('N', (TextSubstitution,), {'perform': lambda self, context: context + 1})\n"
)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("case", DEEP)
def test_an_error_inside_the_library_is_told_by_the_line_that_it_comes_from(
    case: str, tmp_path: Path
) -> None:
    source, line = DEEP[case]
    file = tmp_path / "deep.launch.py"
    file.write_text(HEAD + source)
    assert stopped_at(file, 20.0) == f"deep.launch.py:{line + 2}"

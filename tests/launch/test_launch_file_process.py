"""What the process of a launch file answers is checked against what was asked of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.host.failure import FailureKind, StudentCodeError
from kit.launch.launch_file_process import LaunchFileProcess, declared_arguments
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
        declared_arguments(launch_file, launch_file.parent, [])
    assert caught.value.failure.kind is FailureKind.PROTOCOL

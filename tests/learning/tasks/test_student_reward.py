"""A file with a reward, read and not run."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.learning.tasks.student_reward import (
    MAX_SOURCE_BYTES,
    RewardFileError,
    metric_parameters,
    reward_parameters,
)

REWARD = """
def reward(reached, to_go):
    return reached - to_go

def metric_near(to_go):
    return to_go < 1

raise SystemExit("run")
"""


def test_parameters_are_read_without_running_the_file(tmp_path: Path) -> None:
    file = tmp_path / "reward.py"
    file.write_text(REWARD)
    assert reward_parameters(file) == ("reached", "to_go")
    assert metric_parameters(file) == {"near": ("to_go",)}


def test_a_file_is_read_up_to_its_largest_size(tmp_path: Path) -> None:
    file = tmp_path / "reward.py"
    whole = REWARD.ljust(MAX_SOURCE_BYTES, "#")
    file.write_text(whole)
    assert reward_parameters(file) == ("reached", "to_go")
    file.write_text(whole + "#")
    with pytest.raises(RewardFileError, match=f"larger than {MAX_SOURCE_BYTES // 1024} KiB"):
        reward_parameters(file)

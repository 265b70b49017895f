"""Finds a user's own reward files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from kit.learning.tasks.own_files import own_files, short_text
from kit.learning.tasks.student_reward import RewardFileError, reward_parameters


def own_reward_files(folders: Iterable[Path]) -> tuple[Path, ...]:
    """Every Python file in the folders that has a function ``reward`` which training could call."""
    return tuple(sorted({file for file in own_files(folders, ".py") if _is_reward(file)}))


def _is_reward(file: Path) -> bool:
    if "def reward(" not in short_text(file):
        return False
    try:
        reward_parameters(file)
    except RewardFileError:
        return False
    return True

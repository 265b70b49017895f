"""``kit warm``: one cache for all accounts, which every account finds, and nobody but root writes."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.cli.warm import uses_of_kernels
from kit.host.sandbox import landlock
from kit.learning.tasks.catalogue import task_names
from tests.other_accounts import (
    FIRST_ACCOUNT,
    home_of,
    open_installation,
    run_as,
    warm_installation,
    why_impossible,
)

LIMIT_S = 600
TRAIN = ("train", "turn", "--name", "a", "--algo", "q-learning", "--steps", "2000")
BEGINNINGS = (
    ("run", "maze", "--steps", "60"),
    ("run", "pair_turn_180", "--controller", "fields", "--steps", "60"),
    TRAIN,
)
"""What students begin with."""


def test_every_task_is_used() -> None:
    titles = " ".join(title for title, _ in uses_of_kernels())
    assert all(name in titles for name in task_names())


def test_without_root_nothing_is_shared(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    ended = CliRunner().invoke(main, ["warm", "--shared"])
    assert ended.exit_code == 2
    assert "sudo kit warm --shared" in ended.output


CONFINED = """
import tempfile
from pathlib import Path
from grader.evidence.reader_child import confine_before_reading
from kit.kernels.compilation_progress import PROGRESS
from kit.learning.environment.batch import BatchEnv
from kit.learning.tasks.catalogue import find_task
from kit.world.catalogue import maps_folder
scratch = tempfile.mkdtemp(dir=Path.home())
modules = ("kernels", "grids", "world_kernels", "batch_step")
confine_before_reading(Path(scratch) / "x.py", scratch, kernel_modules=modules, beside=[str(maps_folder())])
BatchEnv(find_task("turn"), 2).reset(0)
print("compiled", PROGRESS.count)
"""
"""A process that reads what was handed in, as the grader's, and then uses kernels."""


@pytest.mark.long
@pytest.mark.timeout(3 * LIMIT_S)
def test_another_account_finds_what_root_has_compiled_unless_others_may_write_it() -> None:
    if problem := why_impossible():
        pytest.skip(problem)
    with open_installation() as installation, home_of(FIRST_ACCOUNT) as home:
        warm_installation(installation)
        folder = installation / "kit" / "kernels" / "__pycache__"
        assert any(folder.glob("*.nbc"))
        for words in BEGINNINGS:
            ended = _kit(installation, home, *words)
            assert ended.returncode == 0, ended.stderr
            assert "Compiling" not in ended.stderr + ended.stdout, words
        if landlock.abi() >= 3:
            confined = run_as(FIRST_ACCOUNT, installation, home, ["-c", CONFINED], LIMIT_S)
            assert confined.stdout == "compiled 0\n", confined.stderr
        assert not list(home.rglob("*.nbc"))
        tried = run_as(
            FIRST_ACCOUNT, installation, home, ["-c", f"open({str(folder / 'x.nbc')!r}, 'w')"], LIMIT_S
        )
        assert "PermissionError" in tried.stderr
        folder.chmod(0o777)
        assert "not used" in _kit(installation, home, "doctor").stdout
        ended = _kit(installation, home, *BEGINNINGS[0])
        assert ended.returncode == 0, ended.stderr
        assert "Compiling" in ended.stderr
        assert list(home.rglob("*.nbc"))


def _kit(installation: Path, home: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return run_as(FIRST_ACCOUNT, installation, home, ["-m", "kit", *words], LIMIT_S)

"""The first start on a machine says what it compiles; the next one has nothing to say."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from kit.kernels.compilation_progress import FIRST_DRIVE, CompilationProgress


def test_it_names_the_function_that_was_asked_for_and_counts_all() -> None:
    told: list[str] = []
    progress = CompilationProgress()
    with progress.told_by(told.append):
        progress.begin("scan")
        progress.begin("hit")
        progress.end()
        assert "scan" in progress.text
        progress.end()
        assert progress.text == ""
        progress.begin("step")
    progress.end()
    assert [each.split(", ")[2].split()[0] for each in told] == ["0", "2"]
    progress.begin("later")
    assert len(told) == 2


def test_beyond_a_first_drive_no_sum_is_named() -> None:
    progress = CompilationProgress()
    for _ in range(FIRST_DRIVE):
        progress.begin("one")
        assert f" of about {FIRST_DRIVE}" in progress.text
        progress.end()
    progress.begin("more")
    assert str(FIRST_DRIVE) in progress.text
    assert " of " not in progress.text


COUNTED = """
import sys
from kit.cli import main
from kit.kernels.compilation_progress import PROGRESS
main(["run", sys.argv[1], "--steps", "10"], standalone_mode=False)
print(PROGRESS.count)
"""


@pytest.mark.long
@pytest.mark.parametrize("place", ["maze", "pair_turn"])
def test_a_first_drive_compiles_about_what_is_said(place: str, tmp_path: Path) -> None:
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(tmp_path / "cache"),
        "KIT_WORKSPACE": str(tmp_path / "kit"),
    }
    command = [sys.executable, "-c", COUNTED, place]
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert int(ended.stdout.splitlines()[-1]) == pytest.approx(FIRST_DRIVE, abs=3)


@pytest.mark.long
def test_a_first_start_tells_by_line_what_is_compiled(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "kit", "run", "maze", "--steps", "10"]
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(tmp_path / "cache"),
        "KIT_WORKSPACE": str(tmp_path / "kit"),
    }
    first, second = (
        subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stderr
        for _ in range(2)
    )
    assert first.count("Compiling for this machine, once: ") > 1
    assert "Compiling" not in second

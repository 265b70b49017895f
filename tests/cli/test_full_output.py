"""On a full disk every command says so in a sentence, on a full standard output too."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

FULL = Path("/dev/full")

pytestmark = [pytest.mark.long, pytest.mark.skipif(not FULL.exists(), reason="there is no /dev/full here")]


@pytest.mark.parametrize(
    "words",
    [
        ("kit", "maps"),
        ("kit", "run", "simple", "--steps", "3"),
        ("kit", "quiz", "--scores"),
        ("kit", "layers", "plan", "canyon"),
        ("kit", "runs"),
        ("kit", "--help"),
        ("kit", "maps", "simple"),
        ("kit", "doctor"),
        ("kit", "world", "check", "maps/maze/world.yaml", "--root", "maps"),
        ("grader", "checks"),
    ],
)
def test_a_full_output_is_one_sentence(words: tuple[str, ...], tmp_path: Path) -> None:
    with FULL.open("wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", *words],
            stdout=full,
            stderr=subprocess.PIPE,
            env={"KIT_WORKSPACE": str(tmp_path), "PATH": "/usr/bin:/bin", "HOME": str(tmp_path)},
            cwd=Path(__file__).parents[2],
            timeout=120,
            check=False,
        )
    text = done.stderr.decode().strip()
    assert done.returncode == 2
    assert text.count("No space left on device") == 1
    assert len(text.splitlines()) == 1


@pytest.mark.parametrize("option", ["--record", "--bag"])
def test_a_full_device_that_is_named_is_said(option: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "kit", "run", "simple", "--steps", "3", option, str(FULL)],
        capture_output=True,
        text=True,
        cwd=Path(__file__).parents[2],
        timeout=120,
        check=False,
    )
    assert done.returncode == 2
    assert str(FULL) in done.stderr
    assert "Traceback" not in done.stderr

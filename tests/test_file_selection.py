"""Which test files a process imports."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.file_selection import may_select, shares

ROOT = Path(__file__).parents[1]
PLAIN = "def test_it(): ..."
SOME_LONG = "@pytest.mark.long\ndef test_it(): ..."
ALL_LONG = "pytestmark = [pytest.mark.pty, pytest.mark.long]\ndef test_it(): ..."
SAMPLED = "@pytest.mark.sampled(4)\ndef test_it(): ..."
SOME_NIGHTLY = "@pytest.mark.nightly\ndef test_it(): ..."
DAILY = "@pytest.mark.daily(5)\n@pytest.mark.long\ndef test_it(): ..."


@pytest.mark.parametrize(
    ("expression", "imported"),
    [
        ("not long", [PLAIN, SOME_LONG, SAMPLED, SOME_NIGHTLY, DAILY]),
        ("long", [SOME_LONG, ALL_LONG, SAMPLED, SOME_NIGHTLY, DAILY]),
        ("long and not nightly", [SOME_LONG, ALL_LONG, SAMPLED, SOME_NIGHTLY, DAILY]),
        ("nightly", [SOME_NIGHTLY, DAILY]),
        ("pty", [PLAIN, SOME_LONG, ALL_LONG, SAMPLED, SOME_NIGHTLY, DAILY]),
        ("not pty and not long", [PLAIN, SOME_LONG, SAMPLED, SOME_NIGHTLY, DAILY]),
    ],
)
def test_a_file_is_imported_if_a_test_in_it_may_be_selected(expression: str, imported: list[str]) -> None:
    files = [PLAIN, SOME_LONG, ALL_LONG, SAMPLED, SOME_NIGHTLY, DAILY]
    assert [text for text in files if may_select(expression, text)] == imported


def test_every_file_is_in_one_share(tmp_path: Path) -> None:
    files = [tmp_path / f"test_{number}.py" for number in range(20)]
    for number, file in enumerate(files):
        file.write_text("#" * (10 + number))
    found = shares(files, 3)
    assert sorted(file for share in found for file in share) == sorted(files)
    sizes = [sum(file.stat().st_size for file in share) for share in found]
    assert max(sizes) - min(sizes) < 30
    assert shares(reversed(files), 3) == found


def test_each_worker_runs_its_share(tmp_path: Path) -> None:
    """In a folder of its own with the real conftest: four files, two workers, each test once."""
    folder = tmp_path / "tests"
    folder.mkdir()
    for number in range(4):
        (folder / f"test_{number}.py").write_text("def test_it(): ...\n")
    options = [
        "-n",
        "2",
        "--dist",
        "each",
        "-v",
        "-p",
        "tests.conftest",
        "--rootdir",
        str(tmp_path),
        str(folder),
    ]
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-c", str(ROOT / "pyproject.toml"), *options],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    passed = re.findall(r"\[(gw\d)\].* PASSED .*(test_\d)\.py", run.stdout)
    assert sorted(name for _, name in passed) == [f"test_{number}" for number in range(4)]
    assert len({worker for worker, _ in passed}) == 2


@pytest.mark.daily(3)
@pytest.mark.long
@pytest.mark.parametrize("expression", ["long", "nightly", "not long"])
def test_no_test_is_lost(expression: str) -> None:
    """With all files imported, the same tests are selected."""

    def selected(*options: str) -> set[str]:
        command = [sys.executable, "-m", "pytest", "-qq", "--collect-only", *options]
        run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
        return {line for line in run.stdout.splitlines() if "::" in line}

    assert selected("-m", expression) == selected(
        "-m", f"({expression}) and (pty or not pty)", "--import-all-tests"
    )

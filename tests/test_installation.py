"""How the kit is installed: the command that adds an extra, and other packages that write over its files."""

from __future__ import annotations

import base64
import hashlib
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Mapping
from configparser import ConfigParser
from pathlib import Path

import pytest

from kit import installation
from kit.cli.process import BAD_INPUT
from kit.installation import (
    TOP_LEVEL,
    constraints_file,
    foreign_distributions,
    install_command,
    overwritten_text,
    requirements,
)
from tests.test_wheel import build_wheel, install_wheel

ROOT = Path(__file__).parents[1]


def record_line(name: str, content: str) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(content.encode()).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def install(site: Path, name: str, version: str, files: Mapping[str, str]) -> None:
    """Installs a distribution as pip does: its files, over whatever is there, and their record."""
    for file, content in files.items():
        (site / file).parent.mkdir(parents=True, exist_ok=True)
        (site / file).write_text(content)
    info = site / f"{name.replace('-', '_')}-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    (info / "RECORD").write_text("".join(record_line(file, content) for file, content in files.items()))


OWN = {
    "kit/__init__.py": "ours",
    "kit/__main__.py": "ours too",
    "kit/py.typed": "",
    "grader/__main__.py": "graded",
}


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of packages, beside which this Python has none but those that come with it."""
    own = [path for path in sys.path if Path(path).name not in ("site-packages", "dist-packages")]
    monkeypatch.setattr(sys, "path", [str(tmp_path), *own])
    return tmp_path


@pytest.mark.parametrize("name", ["kit", "grader", "whatever"])
@pytest.mark.parametrize("only_named", [False, True])
def test_a_package_that_wrote_over_ours_is_found(site: Path, name: str, only_named: bool) -> None:
    install(site, "robot-learning-kit", "0.2.0", OWN)
    install(site, name, "1.2", {"kit/__main__.py": "theirs"})
    expected = [] if only_named and name == "whatever" else [(name, "1.2")]
    assert list(foreign_distributions(only_named=only_named)) == expected


def test_over_which_the_kit_was_installed_again_is_no_trouble(site: Path) -> None:
    install(site, "kit", "1.2", {"kit/__main__.py": "theirs"})
    install(site, "robot-learning-kit", "0.2.0", OWN)
    assert list(foreign_distributions()) == []


def test_files_of_others_beside_ours_and_equal_ones_are_no_trouble(site: Path) -> None:
    install(site, "robot-learning-kit", "0.2.0", OWN)
    install(site, "kit", "1.2", {"kit/more.py": "theirs", "kit/py.typed": ""})
    assert list(foreign_distributions()) == []


def test_the_sentence_names_it_and_the_way_out() -> None:
    text = overwritten_text("kit", "0.2.15")
    assert "kit 0.2.15" in text
    assert f"{shlex.quote(sys.executable)} -m pip uninstall -y kit" in text
    assert "--force-reinstall" in text


@pytest.mark.long
@pytest.mark.parametrize("package", TOP_LEVEL)
def test_the_installed_kit_says_so_at_its_start(tmp_path: Path, package: str) -> None:
    python, site = install_wheel(build_wheel(tmp_path), tmp_path / "venv")
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

    def start(program: str) -> subprocess.CompletedProcess[str]:
        """Starts a program as the script does that pip writes for it."""
        module, _, name = scripts[program].partition(":")
        return subprocess.run(
            [
                python,
                "-c",
                f"import sys; sys.argv[1:] = ['--help']; from {module} import {name}; sys.exit({name}())",
            ],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )

    (record,) = site.glob("robot_learning_kit-*.dist-info/entry_points.txt")
    parser = ConfigParser(delimiters="=")
    parser.read_string(record.read_text())
    scripts = dict(parser["console_scripts"])
    assert [start(each).returncode for each in scripts] == [0, 0, 0]
    theirs = {f"{package}/__init__.py": "", f"{package}/__main__.py": "print 'No Flask app found!'"}
    install(site, package, "0.2.15", theirs)
    for each in scripts:
        ended = start(each)
        assert ended.returncode == BAD_INPUT
        assert f"{package} 0.2.15, has written over" in ended.stderr
        assert "Traceback" not in ended.stderr


def test_the_command_pins_the_tested_versions(monkeypatch: pytest.MonkeyPatch) -> None:
    words = shlex.split(install_command("learn"))
    assert words[:4] == [sys.executable, "-m", "pip", "install"]
    assert Path(words[words.index("-c") + 1]) == constraints_file()
    assert {"torch", "stable-baselines3"} <= set(words)
    monkeypatch.setattr(installation, "requirements", lambda extra=None: ())
    assert shlex.split(install_command("learn"))[-2:] == ["-e", f"{ROOT}[learn]"]


def test_without_pip_uv_installs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(installation, "_is_distribution_installed", lambda name: False)
    monkeypatch.setattr(installation.shutil, "which", lambda name: "/usr/bin/uv")
    assert install_command("learn").startswith(f"uv pip install --python {shlex.quote(sys.executable)} -c ")


def test_the_pins_hold_every_package_that_is_declared() -> None:
    pinned = {
        line.partition("==")[0].lower().replace("_", "-")
        for line in constraints_file().read_text().splitlines()
    }
    declared = {
        name
        for extra in (None, "learn", "robot", "cluster", "tune", "pettingzoo")
        for name in requirements(extra)
    }
    assert {name.lower() for name in declared} <= pinned


def test_torch_for_cuda_cannot_be_chosen() -> None:
    """pip reads the options of a file of constraints; the last line has no version that exists."""
    lines = constraints_file().read_text().splitlines()
    assert any(re.match(r"--extra-index-url \S+/cpu$", line) for line in lines)
    assert "cuda-toolkit==0" in lines

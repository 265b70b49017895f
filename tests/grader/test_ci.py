"""Workflow files: they parse, they harm nobody, and what they call is there: each one's script is run."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import yaml
from click.testing import CliRunner

from grader.__main__ import main
from grader.ci import WORKFLOWS, GitSource, warnings, workflow
from grader.reading import read_assignment
from tests.cases import every_case
from tests.grader.conftest import FORWARD, LOCKS, QUICK, write_assignment

ROOT = Path(__file__).parents[2]
KIT = GitSource("https://example.org/somebody/kit", "v1")


def made(service: str) -> tuple[str, Any]:
    """The text, and what YAML makes of it."""
    text = workflow(service, submit="controller.py", assignment="tasks/one", kit=KIT)
    return text, yaml.safe_load(text)


def invoke(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(main, list(arguments))
    assert not done.exception or isinstance(done.exception, SystemExit), done.exc_info
    return done.exit_code, done.output


@pytest.mark.parametrize("service", WORKFLOWS)
def test_a_workflow_is_whole_and_harmless(service: str) -> None:
    text, content = made(service)
    assert content
    assert not re.search(r"(?<![${]){[a-z]", text), "every name is filled in"
    assert "git clone --quiet --depth 1 --branch v1 https://example.org/somebody/kit" in text
    assert "--quiet robot-learning-kit" not in text, "no name that a package index resolves"
    assert "secrets." not in text


def test_on_github_students_code_runs_without_rights() -> None:
    _, content = made("github")
    assert content["permissions"] == {"contents": "read"}
    assert list(content["jobs"]) == ["grade"]
    grade = content["jobs"]["grade"]
    assert "permissions" not in grade
    assert grade["steps"][0]["with"]["persist-credentials"] is False


def test_every_action_is_githubs_own_and_pinned_by_a_hash() -> None:
    text, content = made("github")
    used = [step["uses"] for step in content["jobs"]["grade"]["steps"] if "uses" in step]
    assert len(used) == 3
    for each in used:
        assert re.fullmatch(r"actions/[a-z-]+@[0-9a-f]{40}", each)
        assert re.search(re.escape(each) + r"  # v\d+\.\d+\.\d+\n", text), "the comment names its version"


@pytest.mark.parametrize(
    ("name", "named"),
    [("secret.yaml", "secret.yaml"), ("solution.py", "solution.py"), ("wrong/a.py", "wrong/")],
)
def test_what_students_should_not_read_is_named(tmp_path: Path, name: str, named: str) -> None:
    folder = write_assignment(tmp_path / "task")
    assert list(warnings(read_assignment(folder), "github")) == []
    (folder / name).parent.mkdir(exist_ok=True)
    (folder / name).write_text("seeds: {turn: [12345678901234]}\n" if name == "secret.yaml" else "")
    (told,) = warnings(read_assignment(folder), "github")
    assert named in told


def test_a_level_that_no_runner_reaches_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_assignment(tmp_path / "task", QUICK.replace("level: 0", "level: 2"))
    monkeypatch.chdir(tmp_path)
    code, text = invoke("ci", "gitlab", "--assignment", "task", "--kit", "https://example.org/x/y")
    assert code == 0
    assert "asks for confinement level 2" in text


def script(service: str) -> str:
    """What the runner's shell is given, without the installation."""
    _, content = made(service)
    if service == "gitlab":
        lines = [line for line in content["grade"]["script"] if "/tmp/kit" not in line]
        return "set -eo pipefail\n" + "\n".join(lines)
    steps = content["jobs"]["grade"]["steps"]
    run: str = next(step["run"] for step in steps if step.get("id") == "grade")
    return "set -eo pipefail\n" + run


@pytest.mark.long
@LOCKS
@pytest.mark.parametrize(("source", "status"), [(FORWARD, 1), (FORWARD.replace("0.3", "0.4"), 0)])
@pytest.mark.parametrize("service", WORKFLOWS)
def test_what_a_workflow_calls_is_there(tmp_path: Path, service: str, source: str, status: int) -> None:
    """Its script in a student's repository, with this Python as ``python``."""
    text = (
        QUICK
        if status
        else QUICK.replace("check: reached, points: 3, after: runs,", "check: runs, id: again, points: 3,")
    )
    write_assignment(tmp_path / "tasks" / "one", text)
    (tmp_path / "controller.py").write_text(source)
    programs = tmp_path / "bin"
    programs.mkdir()
    (programs / "python").write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    (programs / "python").chmod(0o755)
    out = {"GITHUB_STEP_SUMMARY": "summary.md", "RUNNER_TEMP": ""}
    done = subprocess.run(
        [shutil.which("bash") or "/bin/sh", "-c", script(service)],
        cwd=tmp_path,
        env=os.environ
        | {"PATH": f"{programs}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}
        | {key: str(tmp_path / name) for key, name in out.items()},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == status, done.stderr
    assert "of 6 points" in done.stdout
    assert ElementTree.parse(tmp_path / "junit.xml").getroot().tag == "testsuites"
    if service == "github":
        assert "| Test | Outcome | Points |" in (tmp_path / "summary.md").read_text()


def test_a_workflow_is_written_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_assignment(tmp_path / "tasks" / "one")
    monkeypatch.chdir(tmp_path)
    asked = ("--assignment", "tasks/one", "--kit", "https://example.org/somebody/kit@v1")
    assert invoke("ci", "github", *asked, "--write")[0] == 0
    assert (tmp_path / ".github/workflows/grade.yml").read_text() == made("github")[0]
    code, text = invoke("ci", "github", *asked, "--write")
    assert (code, "already exists" in text) == (2, True)
    code, text = invoke("ci", "gitlab", "--assignment", str(tmp_path / "tasks" / "one"), *asked[2:])
    assert (code, "relative" in text) == (2, True)


@every_case(
    "address",
    ["robot-learning-kit", "https://x/y; rm -r /", "https://x/y@$(id)", "git@x:y", "https://x/y@-o"],
)
def test_an_address_that_a_shell_would_read_is_refused(address: str) -> None:
    with pytest.raises(ValueError, match="https://HOST/PATH"):
        GitSource.read(address)

"""Workflow files: they parse, they harm nobody, and what they call is there: each one's script is run."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import yaml
from click.testing import CliRunner

from grader.__main__ import main
from grader.ci import REPOSITORY_SERVICES, SERVICES
from grader.ci.ci_service import CiRunner, GitSource, GradedWork
from grader.ci.warnings import warnings
from grader.reading import read_assignment
from kit.host.sandbox import probe
from kit.host.sandbox.sandbox_config import Level
from tests.cases import every_case
from tests.grader.conftest import FORWARD, LOCKS, QUICK, write_assignment
from tests.public_schemas import why_invalid

ROOT = Path(__file__).parents[3]
KIT = GitSource("https://example.org/somebody/kit", "v1")
ONE = GradedWork("tasks-one", "controller.py", "tasks/one")
TWO = GradedWork("tasks-two", "two/controller.py", "tasks/two")


def workflow(service: str, works: Sequence[GradedWork], kit: GitSource) -> str:
    return SERVICES[service].write(works, kit, CiRunner()).decode()


def made(service: str) -> tuple[str, Any]:
    """The text, and what YAML makes of it."""
    text = workflow(service, [ONE], KIT)
    return text, yaml.safe_load(text)


def invoke(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(main, list(arguments))
    assert not done.exception or isinstance(done.exception, SystemExit), done.exc_info
    return done.exit_code, done.output


@pytest.mark.parametrize("service", REPOSITORY_SERVICES)
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
    assert len(used) == 5
    for each in used:
        assert re.fullmatch(r"actions/[a-z-]+(/[a-z]+)?@[0-9a-f]{40}", each)
        assert re.search(re.escape(each) + r"  # v\d+\.\d+\.\d+\n", text), "the comment names its version"


@pytest.mark.parametrize(
    ("name", "named"),
    [("secret.yaml", "secret.yaml"), ("solution.py", "solution.py"), ("wrong/a.py", "wrong/")],
)
def test_what_students_should_not_read_is_named(tmp_path: Path, name: str, named: str) -> None:
    folder = write_assignment(tmp_path / "task")
    assert list(warnings(read_assignment(folder), SERVICES["github"])) == []
    (folder / name).parent.mkdir(exist_ok=True)
    (folder / name).write_text("seeds: {turn: [12345678901234]}\n" if name == "secret.yaml" else "")
    (told,) = warnings(read_assignment(folder), SERVICES["github"])
    assert named in told


def test_a_level_that_no_runner_reaches_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_assignment(tmp_path / "task", QUICK.replace("level: 0", "level: 2"))
    monkeypatch.chdir(tmp_path)
    code, text = invoke("ci", "gitlab", "--assignment", "task", "--kit", "https://example.org/x/y")
    assert code == 0
    assert "asks for confinement level 2" in text


HOSTILE = """\
import os
with open(os.environ["HOSTILE_MARK"], "a") as mark:
    mark.write(__file__ + "\\n")
"""
"""A module that says that it was run, in the student's place of a trusted one."""
TAKEN_FOR_TRUSTED = (
    "pip.py", "venv.py", "runpy.py", "sitecustomize.py", "usercustomize.py", "json.py", "click.py", "conftest.py",
    "grader/__init__.py", "grader/__main__.py", "kit/__init__.py", "pip/__init__.py", "pip/__main__.py",
)  # fmt: skip
PROGRAMS = ("git", "python", "mkdir", "cp", "rm")


def write_hostile_files(checkout: Path) -> None:
    """Writes what a student could lay beside the program: modules, programs, and a result with all points."""
    for name in TAKEN_FOR_TRUSTED:
        (checkout / name).parent.mkdir(exist_ok=True)
        (checkout / name).write_text(HOSTILE)
    for name in PROGRAMS:
        (checkout / name).write_text('#!/bin/sh\necho "$0" >> "$HOSTILE_MARK"\n')
        (checkout / name).chmod(0o755)
    for folder in (checkout, checkout / ".grade"):
        folder.mkdir(exist_ok=True)
        (folder / "result.json").write_text('{"verdict": "pass", "points": 6, "maximum": 6}')
        (folder / "junit.xml").write_text("<testsuites forged='yes'/>")


def steps(service: str, works: Sequence[GradedWork] = (ONE,)) -> list[tuple[str, dict[str, str]]]:
    """What the runner's shell is given, one text for each of its starts, with what the runner fills in."""
    content = yaml.safe_load(workflow(service, works, KIT))
    if service == "gitlab":
        return [("set -eo pipefail\n" + "\n".join(content["grade"]["script"]), {})]
    assert content["defaults"]["run"] == {"shell": "bash", "working-directory": "${{ runner.temp }}"}
    return [
        ("set -eo pipefail\n" + step["run"], step)
        for step in content["jobs"]["grade"]["steps"]
        if "run" in step
    ]


def run_workflow(
    service: str, checkout: Path, folder: Path, works: Sequence[GradedWork] = (ONE,)
) -> subprocess.CompletedProcess[str]:
    """Runs a service's script as its runner does: in the checkout, or where the workflow says, with this Python as
    ``python``. Nothing is fetched: ``git clone`` makes a folder, and ``pip install`` only imports pip."""
    programs, temporary = folder / "bin", folder / "temp"
    programs.mkdir()
    temporary.mkdir()
    (programs / "git").write_text('#!/bin/sh\nfor last; do :; done\nmkdir "$last"\n')
    fetches_nothing = 'case "$*" in *"-m pip install"*) set -- "$1" -c "import pip" ;; esac\n'
    (programs / "python").write_text(f'#!/bin/sh\n{fetches_nothing}exec "{sys.executable}" "$@"\n')
    for program in programs.iterdir():
        program.chmod(0o755)
    environment = {
        # A careless runner: what has no path of its own is looked for in the working folder too.
        "PATH": f"{programs}:.:{os.environ['PATH']}",
        "HOSTILE_MARK": str(folder / "hostile.txt"),
        "HOME": str(folder),
        "TMPDIR": str(temporary),
        "GITHUB_WORKSPACE": str(checkout),
        "GITHUB_STEP_SUMMARY": str(folder / "summary.md"),
        "GITHUB_OUTPUT": str(folder / "output.txt"),
        "GITHUB_ENV": str(folder / "env.txt"),
        "RUNNER_TEMP": str(temporary),
        "CI_PROJECT_DIR": str(checkout),
        "PYTHONPYCACHEPREFIX": str(folder / "cache"),
        "PYTHONPATH": str(ROOT),
    }
    cwd = {"github": temporary, "gitlab": checkout}[service]
    done = subprocess.CompletedProcess[str]([], 0, "", "")
    for text, _ in steps(service, works):
        done = subprocess.run(
            [shutil.which("bash") or "/bin/sh", "-c", text],
            cwd=cwd,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            break
    return done


@pytest.mark.long
@LOCKS
@pytest.mark.parametrize(("source", "status"), [(FORWARD, 1), (FORWARD.replace("0.3", "0.4"), 0)])
@pytest.mark.parametrize("service", REPOSITORY_SERVICES)
def test_a_workflow_grades_and_runs_nothing_of_the_students(
    tmp_path: Path, service: str, source: str, status: int
) -> None:
    checkout = tmp_path / "checkout"
    text = (
        QUICK
        if status
        else QUICK.replace("check: reached, points: 3, after: runs,", "check: runs, id: again, points: 3,")
    )
    write_assignment(checkout / "tasks" / "one", text)
    (checkout / "controller.py").write_text(source)
    write_hostile_files(checkout)
    done = run_workflow(service, checkout, tmp_path)
    assert not (tmp_path / "hostile.txt").exists(), (tmp_path / "hostile.txt").read_text()
    assert done.returncode == status, done.stderr
    assert "of 6 points" in done.stdout
    results = {"github": tmp_path / "temp" / "grade", "gitlab": checkout / ".grade"}[service]
    assert ElementTree.parse(results / "tasks-one.xml").getroot().tag == "testsuites"
    assert "forged" not in (results / "tasks-one.xml").read_text()
    assert json.loads((results / "tasks-one.json").read_text())["level"] == int(
        probe.highest_level_up_to(Level.ANOTHER_USER)
    )
    if service == "github":
        assert "::notice title=" in done.stdout
        assert "| Test | Outcome | Points |" in (tmp_path / "summary.md").read_text()


@pytest.mark.parametrize("service", REPOSITORY_SERVICES)
def test_a_result_that_lay_in_the_checkout_is_not_reported(tmp_path: Path, service: str) -> None:
    """The work is refused, so that this run writes none."""
    checkout = tmp_path / "checkout"
    write_assignment(checkout / "tasks" / "one")
    write_hostile_files(checkout)
    (checkout / "controller.py").mkdir()
    done = run_workflow(service, checkout, tmp_path)
    assert not (tmp_path / "hostile.txt").exists(), (tmp_path / "hostile.txt").read_text()
    assert done.returncode == 2, done.stderr
    assert "points" not in done.stdout
    results = {"github": tmp_path / "temp" / "grade", "gitlab": checkout / ".grade"}[service]
    assert not results.exists() or not any(results.iterdir())


@pytest.mark.long
@LOCKS
@pytest.mark.parametrize("service", REPOSITORY_SERVICES)
def test_one_workflow_grades_all_assignments_that_are_begun(tmp_path: Path, service: str) -> None:
    checkout = tmp_path / "checkout"
    for name in ("one", "two", "three"):
        write_assignment(checkout / "tasks" / name)
    (checkout / "controller.py").write_text(FORWARD)
    (checkout / "two").mkdir()
    (checkout / "two" / "controller.py").write_text("1/0\n")
    works = (ONE, TWO, GradedWork("tasks-three", "three.py", "tasks/three"))
    done = run_workflow(service, checkout, tmp_path, works)
    assert done.returncode == 1, done.stderr
    results = {"github": tmp_path / "temp" / "grade", "gitlab": checkout / ".grade"}[service]
    assert {each.name for each in results.glob("*.json")} == {"tasks-one.json", "tasks-two.json"}
    assert "three.py is not there yet" in done.stdout
    if service == "github":
        assert "::error file=two/controller.py,line=1," in done.stdout
        assert (tmp_path / "summary.md").read_text().count("| Test | Outcome | Points |") == 2


def test_gradescope_gets_an_archive_with_everything(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_assignment(tmp_path / "task", secret="seeds: {turn: [12345678901234]}\n")
    monkeypatch.chdir(tmp_path)
    code, text = invoke("ci", "gradescope", "--assignment", "task", "--kit", "https://example.org/x/y@v1")
    assert code == 0, text
    with zipfile.ZipFile("autograder.zip") as archive:
        names = archive.namelist()
        assert {"setup.sh", "run_autograder", "assignment/assignment.yaml", "assignment/secret.yaml"} == set(
            names
        )
        for name in ("setup.sh", "run_autograder"):
            assert archive.getinfo(name).external_attr >> 16 & 0o111
            script = archive.read(name).decode()
            checked = subprocess.run(
                ["bash", "-n"], input=script, text=True, capture_output=True, check=False
            )
            assert checked.returncode == 0, checked.stderr
        assert "--secret --level highest --format gradescope" in archive.read("run_autograder").decode()


@pytest.mark.long
@LOCKS
def test_classroom50s_runner_gets_its_result(tmp_path: Path) -> None:
    """The script as the runner starts it, but for what it fetches."""
    bundle, checkout = tmp_path / "bundle", tmp_path / "checkout"
    write_assignment(bundle / "assignment")
    checkout.mkdir()
    (checkout / "controller.py").write_text(FORWARD)
    (checkout / "result.json").write_text('{"score": 1000}')
    script = workflow("classroom50", [GradedWork("one", "controller.py", "one")], KIT)
    fetched = 'subprocess.run("git clone', "subprocess.run([sys.executable, *install]"
    for each in fetched:
        assert each in script
        script = script.replace(each, each.replace("subprocess.run", "(lambda *_, **__: None)"))
    (bundle / "autograder.py").write_text(script)
    variables = ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "COMMIT_URL", "RELEASE_URL")
    done = subprocess.run(
        [sys.executable, str(bundle / "autograder.py")],
        cwd=checkout,
        env={
            **os.environ,
            "PYTHONPATH": str(ROOT),
            **{name: f"the-{name}" for name in variables},
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    result = json.loads((checkout / "result.json").read_text())
    # The keys that its public contract names, and no others.
    assert set(result) == {
        *("schema", "classroom", "assignment", "submission", "commit", "release", "review", "datetime"),
        *("score", "max-score", "tests"),
    }
    assert result["schema"] == "classroom50/result/v1"
    assert (result["score"], result["max-score"]) == (3, 6)
    assert sum(test["score"] for test in result["tests"]) == result["score"]
    assert {"test-name", "passed", "score", "max-score"} == set(result["tests"][0])


def test_the_hostile_files_would_be_run_in_the_checkout(tmp_path: Path) -> None:
    """The control: the script of before, which started pip in the student's folder, runs the student's."""
    checkout = tmp_path / "checkout"
    checkout.mkdir()
    write_hostile_files(checkout)
    mark = tmp_path / "hostile.txt"
    subprocess.run(
        [sys.executable, "-m", "pip", "--version"],
        cwd=checkout,
        env=os.environ | {"HOSTILE_MARK": str(mark)},
        capture_output=True,
        check=False,
    )
    assert mark.exists()


def test_workflows_are_valid_by_the_services_public_schemas(tmp_path: Path) -> None:
    for service, schema in (("github", "github-workflows"), ("gitlab", "gitlab-ci")):
        files = []
        for works in ([ONE], [ONE, TWO]):
            files.append(tmp_path / f"{service}-{len(works)}.yml")
            files[-1].write_text(workflow(service, works, KIT))
        assert why_invalid(schema, *files) == ""
        spoiled = tmp_path / "spoiled.yml"
        spoiled.write_text(files[0].read_text().replace("script:", "scripts:").replace("steps:", "step:"))
        assert "spoiled.yml" in why_invalid(schema, spoiled)


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

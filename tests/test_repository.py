"""What a repository is expected to have: workflows, forms, a changelog, versions that agree, and nothing else at its top."""

from __future__ import annotations

import re
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

import kit
from grader.ci.services.github import ACTIONS
from tests.public_schemas import why_invalid

ROOT = Path(__file__).parents[1]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
FORMS = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())
TOP_LEVEL = {
    "kit",
    "lessons",
    "maps",
    "grader",
    "tests",
    "pyproject.toml",
    "README.md",
    "LICENSE",
    "constraints.txt",
}


def read(file: Path) -> Any:
    content = yaml.safe_load(file.read_text())
    # YAML 1.1 reads the key `on` as true.
    return {("on" if key is True else key): value for key, value in content.items()}


def test_the_top_holds_what_it_may() -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    if listed.returncode:
        pytest.skip("not a git checkout")
    names = {line.partition("/")[0] for line in listed.stdout.splitlines()}
    assert {name for name in names if not name.startswith(".")} <= TOP_LEVEL


def test_workflows_and_forms_are_valid_by_public_schemas() -> None:
    forms = [file for file in FORMS if file.stem != "config"]
    assert why_invalid("github-workflows", *WORKFLOWS) == ""
    assert why_invalid("github-issue-forms", *forms) == ""
    assert why_invalid("github-issue-config", FORMS[0].with_name("config.yml")) == ""


@pytest.mark.parametrize("file", WORKFLOWS, ids=lambda file: file.stem)
class TestWorkflow:
    def test_pins_every_action_by_a_hash_and_names_its_version(self, file: Path) -> None:
        used = re.findall(r"uses: (.+)", file.read_text())
        assert used
        for each in used:
            assert re.fullmatch(r"actions/[a-z-]+@[0-9a-f]{40}  # v\d+\.\d+\.\d+", each), each

    def test_uses_the_same_releases_as_the_workflows_of_teachers(self, file: Path) -> None:
        known = {name.replace("_", "-"): pin for name, pin in ACTIONS.items()}
        for name, pin in re.findall(r"uses: actions/([a-z-]+)@(.+)", file.read_text()):
            assert known.get(name, pin) == pin

    def test_has_few_rights_and_an_end(self, file: Path) -> None:
        content = read(file)
        assert content["permissions"] == {"contents": "read"}
        for job in content["jobs"].values():
            assert job["timeout-minutes"] <= 340
            for step in job["steps"]:
                if "checkout" in step.get("uses", ""):
                    assert step["with"]["persist-credentials"] is False

    def test_runs_what_is_there(self, file: Path) -> None:
        for script in re.findall(r"run: (\.ci/\S+)", file.read_text()):
            assert (ROOT / script).stat().st_mode & 0o111


def supported_pythons() -> list[str]:
    """The versions that the classifiers name."""
    return [
        each.rpartition(" ")[2]
        for each in PROJECT["project"]["classifiers"]
        if re.search(r":: 3\.\d+$", each)
    ]


def test_every_supported_python_is_tested() -> None:
    versions = supported_pythons()
    matrix = read(ROOT / ".github" / "workflows" / "tests.yml")["jobs"]["tests"]["strategy"]["matrix"][
        "python"
    ]
    assert matrix == versions
    minors = [int(each.partition(".")[2]) for each in versions]
    assert PROJECT["project"]["requires-python"] == f">=3.{minors[0]},<3.{minors[-1] + 1}"
    assert minors == list(range(minors[0], minors[-1] + 1))


def test_the_version_is_one_and_the_changelog_begins_with_it() -> None:
    assert PROJECT["project"]["version"] == kit.__version__
    versions = re.findall(r"^## (\S+)$", (ROOT / ".github" / "CHANGELOG.md").read_text(), re.M)
    assert versions[0] == kit.__version__
    assert len(set(versions)) == len(versions)


@pytest.mark.parametrize(
    "file", [form for form in FORMS if form.stem != "config"], ids=lambda file: file.stem
)
def test_a_form_asks(file: Path) -> None:
    content = yaml.safe_load(file.read_text())
    assert content["name"]
    assert content["description"]
    assert len({each["id"] for each in content["body"]}) == len(content["body"])
    assert any(each.get("validations", {}).get("required") for each in content["body"])

"""Generates CI workflow files for a repository whose pushes are graded.

The job that runs students' code has a read-only token and no secrets. For a grade that counts, keep the workflow and the
assignment in the teacher's repository, not in the student's: whoever may push may change both.

Every trusted program starts with ``-P`` in a folder that the student cannot write: ``python -m pip`` in the checkout would run a
student's ``pip.py``. What is reported is what this run has written, outside the checkout.

One workflow grades all assignments of a repository. The kit is installed from its source repository with its tested versions, never by a name that a package index would
have to resolve.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from grader.assignment import TEACHERS_STEMS, Assignment
from kit.host.sandbox.confinement import Level
from kit.plain_text import join_names

ACTIONS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "checkout": "de0fac2e4500dabe0009e67214ff5f5447ce83dd  # v6.0.2",
        "setup_python": "a309ff8b426b58ec0e2a45f0f869d46889d02405  # v6.2.0",
        "cache": "0057852bfaa89a56745cba8c7296529d2fc39830  # v4.3.0",
        "upload_artifact": "043fb46d1a93c77aae656e7c1c64a875d1fc6a0a  # v7.0.1",
    }
)
"""GitHub's own actions, each by the hash of a release, which nobody can move as a tag can be moved."""

GITHUB: Final = """\
# Made by `grader ci github`. Grades every push and every pull request of a fork.
name: Grade
on: [push, pull_request, workflow_dispatch]
permissions:
  contents: read          # student code runs below: no token that could write
concurrency:              # of several pushes only the newest is graded
  group: grade-${{{{ github.event.pull_request.number || github.ref }}}}
  cancel-in-progress: true
defaults:
  run:
    shell: bash
    working-directory: ${{{{ runner.temp }}}}  # nothing but the grader's sandbox starts in the student's folder
jobs:
  grade:
    # A pull request within the repository is graded as the push that it is.
    if: github.event_name != 'pull_request' || github.event.pull_request.head.repo.full_name != github.repository
    runs-on: {runner}
    timeout-minutes: {minutes}
    steps:
      - uses: actions/checkout@{checkout}
        with:
          persist-credentials: false
      - uses: actions/setup-python@{setup_python}
        with:
          python-version: "{python}"
      - name: Fetch the kit
        id: kit
        run: |
          git clone --quiet --depth 1 {clone} kit
          echo "version=$(git -C kit rev-parse HEAD)" >> "$GITHUB_OUTPUT"
          # Outside the checkout, where no commit can put anything.
          echo "PIP_CACHE_DIR=$RUNNER_TEMP/kit-cache/pip" >> "$GITHUB_ENV"
          echo "NUMBA_CACHE_DIR=$RUNNER_TEMP/kit-cache/numba" >> "$GITHUB_ENV"
      - id: cache           # packages, and kernels that are compiled already
        uses: actions/cache/restore@{cache}
        with:
          path: ${{{{ runner.temp }}}}/kit-cache
          key: kit-{runner}-{python}-${{{{ steps.kit.outputs.version }}}}
      - name: Install the kit
        run: python -P -m pip install --quiet -c kit/constraints.txt ./kit
      - name: Grade
        run: |
          mkdir grade
          worst=0
          graded=0
          while read -r name work assignment; do
            if [ ! -e "$GITHUB_WORKSPACE/$work" ]; then
              echo "$name: $work is not there yet"
              continue
            fi
            graded=1
            status=0
            python -P -m grader check "$GITHUB_WORKSPACE/$work" --assignment "$GITHUB_WORKSPACE/$assignment" \\
              --level highest --json --for-student --output "grade/$name.json" < /dev/null || status=$?
            if [ "$status" -gt "$worst" ]; then worst=$status; fi
            if [ ! -s "grade/$name.json" ]; then continue; fi
            python -P -m grader report "grade/$name.json" --format markdown < /dev/null >> "$GITHUB_STEP_SUMMARY"
            python -P -m grader report "grade/$name.json" --format junit --output "grade/$name.xml" < /dev/null
            python -P -m grader report "grade/$name.json" < /dev/null
            python -P -m grader report "grade/$name.json" --format annotations --work "$work" < /dev/null
          done <<'ASSIGNMENTS'
{lines}
          ASSIGNMENTS
          if [ "$graded" = 0 ]; then exit 2; fi
          exit "$worst"
      - if: always() && steps.cache.outputs.cache-hit != 'true'
        uses: actions/cache/save@{cache}
        with:
          path: ${{{{ runner.temp }}}}/kit-cache
          key: kit-{runner}-{python}-${{{{ steps.kit.outputs.version }}}}
      - uses: actions/upload-artifact@{upload_artifact}
        if: always()
        with:
          name: grade
          path: ${{{{ runner.temp }}}}/grade
"""

# No cache: GitLab's lies in the checkout, where a student's commit could fill it with what trusted programs then read.
GITLAB: Final = """\
# Made by `grader ci gitlab`. Grades every push.
grade:
  image: python:{python}
  timeout: {minutes} minutes
  interruptible: true       # of several pushes only the newest is graded, with the project's auto-cancel
  variables:
    GIT_DEPTH: "1"
  script:
    - cd /  # nothing but the grader's sandbox starts in the student's folder
    - rm -rf "$CI_PROJECT_DIR/.grade"  # what a student commits under this name is no result
    - cd "$(mktemp -d)"
    - git clone --quiet --depth 1 {clone} kit
    - python -P -m pip install --quiet -c kit/constraints.txt ./kit
    - |
      mkdir grade
      worst=0
      graded=0
      while read -r name work assignment; do
        if [ ! -e "$CI_PROJECT_DIR/$work" ]; then
          echo "$name: $work is not there yet"
          continue
        fi
        graded=1
        status=0
        python -P -m grader check "$CI_PROJECT_DIR/$work" --assignment "$CI_PROJECT_DIR/$assignment" \\
          --level highest --json --for-student --output "grade/$name.json" < /dev/null || status=$?
        if [ "$status" -gt "$worst" ]; then worst=$status; fi
        if [ ! -s "grade/$name.json" ]; then continue; fi
        python -P -m grader report "grade/$name.json" --format junit --output "grade/$name.xml" < /dev/null
        python -P -m grader report "grade/$name.json" < /dev/null
        mkdir -p "$CI_PROJECT_DIR/.grade"
        cp "grade/$name.json" "grade/$name.xml" "$CI_PROJECT_DIR/.grade"
      done <<'ASSIGNMENTS'
{lines}
      ASSIGNMENTS
      if [ "$graded" = 0 ]; then exit 2; fi
      exit "$worst"
  artifacts:
    when: always
    paths: [.grade]
    reports:
      junit: .grade/*.xml
"""

CLASSROOM50: Final = """\
#!/usr/bin/env python3
\"\"\"Made by `grader ci classroom50`: put it beside a copy of the assignment's folder, called `assignment`.

Classroom 50's runner starts it in the student's checkout and takes the result.json that it writes there.
\"\"\"

import subprocess
import sys
import tempfile
from pathlib import Path

HERE, CHECKOUT = Path(__file__).resolve().parent, Path.cwd()
RESULT = CHECKOUT / "result.json"
RESULT.unlink(missing_ok=True)  # what a student commits under this name is no result
with tempfile.TemporaryDirectory() as folder:
    # Nothing but the grader's sandbox starts in the student's folder, and -P keeps its modules out.
    subprocess.run("git clone --quiet --depth 1 {clone} kit".split(), cwd=folder, check=True)
    install = "-P -m pip install --quiet -c kit/constraints.txt ./kit".split()
    subprocess.run([sys.executable, *install], cwd=folder, check=True)
    check = ["-P", "-m", "grader", "check", str(CHECKOUT / "{work}"), "--assignment", str(HERE / "assignment")]
    check += ["--level", "highest", "--format", "classroom50", "--output", str(RESULT)]
    status = subprocess.run([sys.executable, *check], cwd=folder).returncode
sys.exit(0 if status in (0, 1) else status)  # a failing grade is no failure of the runner
"""

GRADESCOPE_SETUP: Final = """\
#!/usr/bin/env bash
# Made by `grader ci gradescope`. Installs the kit when Gradescope builds the autograder.
set -euo pipefail
apt-get update
apt-get install -y git python3.12 python3.12-venv || apt-get install -y git python3.11 python3.11-venv
python=$(command -v python3.12 || command -v python3.11)
git clone --quiet --depth 1 {clone} /opt/kit
"$python" -m venv /opt/grader
/opt/grader/bin/python -P -m pip install --quiet -c /opt/kit/constraints.txt /opt/kit
"""

GRADESCOPE_RUN: Final = """\
#!/usr/bin/env bash
# Made by `grader ci gradescope`. Grades one submission, with the secret seeds of the assignment in this archive.
cd /autograder/source
/opt/grader/bin/python -P -m grader check /autograder/submission --assignment /autograder/source/assignment \\
  {secret}--level highest --format gradescope --output /autograder/results/results.json 2> /tmp/said.txt
if [ ! -s /autograder/results/results.json ]; then
  # What cannot be read earns nothing here, since Gradescope knows no blank; the student reads why and hands in again.
  /opt/grader/bin/python -P -c 'import json, sys
said = open("/tmp/said.txt", encoding="utf-8", errors="replace").read()[-4000:]
json.dump({{"score": 0, "output": said, "output_format": "text", "stdout_visibility": "hidden"}}, sys.stdout)' \\
    > /autograder/results/results.json
fi
"""


@dataclass(frozen=True, slots=True)
class GradedWork:
    """One assignment of a repository, and where the student's work for it lies."""

    name: str
    """Used in the names of files."""
    work: str
    """File or folder, relative to the repository."""
    assignment: str
    """Folder, relative to the repository."""


@dataclass(frozen=True, slots=True)
class CiService:
    """On what a workflow runs."""

    python: str = "3.12"
    image: str = "ubuntu-24.04"
    minutes: int = 15


WORKFLOWS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "github": (".github/workflows/grade.yml", GITHUB),
        "gitlab": (".gitlab-ci.yml", GITLAB),
        "classroom50": ("autograder.py", CLASSROOM50),
    }
)
"""Path of the workflow file and its text, by service."""
REPOSITORY_SERVICES: Final = ("github", "gitlab")
"""Those whose workflow lies in the repository of the student."""
GRADESCOPE: Final = "gradescope"
GRADESCOPE_ARCHIVE: Final = "autograder.zip"


@dataclass(frozen=True, slots=True)
class GitSource:
    """Address and version of the kit's source repository."""

    address: str
    """For ``git clone``."""
    version: str = ""
    """A branch or tag; empty for the default branch."""

    @classmethod
    def read(cls, text: str) -> GitSource:
        """``https://HOST/PATH`` or ``https://HOST/PATH@VERSION``. Raises ValueError for anything else, since the text goes into a shell script."""
        found = _ADDRESS.fullmatch(text)
        if found is None:
            raise ValueError(f"{text}: give https://HOST/PATH, optionally followed by @ and a branch or tag")
        return cls(found["address"], found["version"] or "")

    @property
    def clone(self) -> str:
        """The arguments for ``git clone``."""
        return f"--branch {self.version} {self.address}" if self.version else self.address


_ADDRESS: Final = re.compile(
    r"(?P<address>https://[A-Za-z0-9.-]+(:[0-9]+)?(/[A-Za-z0-9_.~-]+)+)(@(?P<version>[A-Za-z0-9_][A-Za-z0-9_./-]*))?"
)


def workflow(
    service: str, works: Sequence[GradedWork], kit: GitSource, runner: CiService = CiService()
) -> str:
    """Returns the text of a service's workflow file. The names go into a shell's double quotes, so they must be plain."""
    text = WORKFLOWS[service][1]
    indent = re.search(r"^( *)ASSIGNMENTS$", text, re.MULTILINE)
    margin = "" if indent is None else indent[1]
    return text.format(
        lines="\n".join(f"{margin}{each.name} {each.work} {each.assignment}" for each in works),
        work=works[0].work,
        clone=kit.clone,
        python=runner.python,
        runner=runner.image,
        minutes=runner.minutes,
        **ACTIONS,
    )


def gradescope_archive(assignment: Assignment, kit: GitSource) -> bytes:
    """Returns Gradescope's autograder.zip: what it installs, what it runs, and the whole assignment with its secrets, which
    students never see there. Raises OSError."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        secret = "--secret " if assignment.has_secrets else ""
        for name, text in (
            ("setup.sh", GRADESCOPE_SETUP.format(clone=kit.clone)),
            ("run_autograder", GRADESCOPE_RUN.format(secret=secret)),
        ):
            _add(archive, name, text.encode(), 0o755)
        for file in sorted(path for path in assignment.folder.rglob("*") if path.is_file()):
            inside = file.relative_to(assignment.folder)
            if not any(part.startswith((".", "__")) for part in inside.parts):
                _add(archive, f"assignment/{inside.as_posix()}", file.read_bytes(), 0o644)
    return packed.getvalue()


def _add(archive: zipfile.ZipFile, name: str, data: bytes, mode: int) -> None:
    entry = zipfile.ZipInfo(name)  # without a time: equal contents give equal bytes
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.external_attr = mode << 16
    archive.writestr(entry, data)


HOSTED_LEVEL: Final = Level.FILTERED
"""The highest confinement level of the services' own runners: Ubuntu 24.04's AppArmor and Docker's default profile keep
an ordinary user from making namespaces, which level 2 needs."""


def warnings(assignment: Assignment, service: str) -> Iterator[str]:
    """Yields what would go wrong with this assignment on this service, and the way out."""
    found = sorted(
        each.name + "/" * each.is_dir() for each in assignment.folder.iterdir() if each.stem in TEACHERS_STEMS
    )
    if found and service in REPOSITORY_SERVICES:
        yield (
            f"WARNING: {assignment.folder} contains {join_names(found)}. Anyone who can read the repository can read that. Leave "
            "it out of a repository that students have, and grade with it on your own machine: grader cohort --secret."
        )
        if any(name.startswith("reference") for name in found):
            yield "The checks of this kind compare with the reference: without it they cannot run, in CI neither."
    if assignment.level > HOSTED_LEVEL:
        yield (
            f"WARNING: the assignment asks for confinement level {int(assignment.level)}; {SERVICE_NAMES[service]} own "
            f"runners reach {int(HOSTED_LEVEL)}, so every push would end with exit code 2. Write level: {int(HOSTED_LEVEL)} "
            "in its assignment.yaml, or use a runner of your own on which `kit doctor` shows the level."
        )


SERVICE_NAMES: Final[Mapping[str, str]] = MappingProxyType(
    {"github": "GitHub's", "gitlab": "GitLab's", "classroom50": "GitHub's", GRADESCOPE: "Gradescope's"}
)

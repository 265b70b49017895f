"""Generates CI workflow files for a repository whose pushes are graded.

The job that runs students' code has a read-only token and no secrets. For a grade that counts, keep the workflow and the
assignment in the teacher's repository, not in the student's: whoever may push may change both.

Every trusted program starts with ``-P`` in a folder that the student cannot write: ``python -m pip`` in the checkout would run a
student's ``pip.py``. What is reported is what this run has written, outside the checkout.

The kit is installed from its source repository with its tested versions, never by a name that a package index would
have to resolve.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
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
        "upload_artifact": "043fb46d1a93c77aae656e7c1c64a875d1fc6a0a  # v7.0.1",
    }
)
"""GitHub's own actions, each by the hash of a release, which nobody can move as a tag can be moved."""

GITHUB: Final = """\
# Made by `grader ci github`. Grades {submit} on every push.
name: Grade
on: [push, workflow_dispatch]
permissions:
  contents: read          # student code runs below: no token that could write
defaults:
  run:
    shell: bash
    working-directory: ${{{{ runner.temp }}}}  # nothing but the grader's sandbox starts in the student's folder
jobs:
  grade:
    runs-on: ubuntu-24.04
    timeout-minutes: 15
    steps:
      - uses: actions/checkout@{checkout}
        with:
          persist-credentials: false
      - uses: actions/setup-python@{setup_python}
        with:
          python-version: "3.12"
      - name: Install the kit
        run: |
          git clone --quiet --depth 1 {clone} kit
          python -P -m pip install --quiet -c kit/constraints.txt ./kit
      - name: Grade
        run: |
          mkdir grade
          status=0
          python -P -m grader check "$GITHUB_WORKSPACE/{submit}" --assignment "$GITHUB_WORKSPACE/{assignment}" \\
            --level highest --json --for-student --output grade/result.json || status=$?
          if [ ! -s grade/result.json ]; then exit "$status"; fi
          python -P -m grader report grade/result.json --format markdown >> "$GITHUB_STEP_SUMMARY"
          python -P -m grader report grade/result.json --format junit --output grade/junit.xml
          python -P -m grader report grade/result.json
          exit "$status"
      - uses: actions/upload-artifact@{upload_artifact}
        if: always()
        with:
          name: grade
          path: ${{{{ runner.temp }}}}/grade
"""

GITLAB: Final = """\
# Made by `grader ci gitlab`. Grades {submit} on every push.
grade:
  image: python:3.12
  timeout: 15 minutes
  variables:
    GIT_DEPTH: "1"
  script:
    - cd /  # nothing but the grader's sandbox starts in the student's folder
    - rm -rf "$CI_PROJECT_DIR/.grade"  # what a student commits under this name is no result
    - cd "$(mktemp -d)"
    - git clone --quiet --depth 1 {clone} kit
    - python -P -m pip install --quiet -c kit/constraints.txt ./kit
    - >-
      python -P -m grader check "$CI_PROJECT_DIR/{submit}" --assignment "$CI_PROJECT_DIR/{assignment}"
      --level highest --json --for-student --output result.json || status=$?
    - if [ ! -s result.json ]; then exit "${{status:-1}}"; fi
    - python -P -m grader report result.json --format junit --output junit.xml
    - mkdir "$CI_PROJECT_DIR/.grade" && cp result.json junit.xml "$CI_PROJECT_DIR/.grade"
    - python -P -m grader report result.json
    - exit ${{status:-0}}
  artifacts:
    when: always
    paths: [.grade/result.json]
    reports:
      junit: .grade/junit.xml
"""

WORKFLOWS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {"github": (".github/workflows/grade.yml", GITHUB), "gitlab": (".gitlab-ci.yml", GITLAB)}
)
"""Path of the workflow file and its text, by service."""


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


def workflow(service: str, *, submit: str, assignment: str, kit: GitSource) -> str:
    """Returns the text of a service's workflow file. The names go into a shell's double quotes, so they must be plain."""
    return WORKFLOWS[service][1].format(submit=submit, assignment=assignment, clone=kit.clone, **ACTIONS)


HOSTED_LEVEL: Final = Level.FILTERED
"""The highest confinement level of the services' own runners: Ubuntu 24.04's AppArmor and Docker's default profile keep
an ordinary user from making namespaces, which level 2 needs."""


def warnings(assignment: Assignment, service: str) -> Iterator[str]:
    """Yields what would go wrong with this assignment on this service, and the way out."""
    found = sorted(
        each.name + "/" * each.is_dir() for each in assignment.folder.iterdir() if each.stem in TEACHERS_STEMS
    )
    if found:
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


SERVICE_NAMES: Final[Mapping[str, str]] = MappingProxyType({"github": "GitHub's", "gitlab": "GitLab's"})

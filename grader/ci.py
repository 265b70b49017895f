"""Generates CI workflow files for a repository whose pushes are graded.

The job that runs students' code has a read-only token and no secrets; a second job publishes its result. For a grade
that counts, keep the workflow and the assignment in the teacher's repository, not in the student's.

The kit is installed from its source repository with its tested versions, never by a name that a package index would
have to resolve.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

GITHUB: Final = """\
# Made by `grader ci github`. Grades {submit} on every push.
name: Grade
on: [push, workflow_dispatch]
permissions:
  contents: read          # student code runs below: no token that could write
jobs:
  grade:
    runs-on: ubuntu-24.04
    timeout-minutes: 15
    outputs:
      result: ${{{{ steps.classroom.outputs.result }}}}
    steps:
      - uses: actions/checkout@v4
        with:
          persist-credentials: false
      - uses: actions/setup-python@v5
        with:
          python-version: "3.12"
      - name: Install the kit
        run: |
          git clone --quiet --depth 1 {clone} "$RUNNER_TEMP/kit"
          python -m pip install --quiet -c "$RUNNER_TEMP/kit/constraints.txt" "$RUNNER_TEMP/kit"
      - name: Grade
        id: classroom
        shell: bash
        run: |
          status=0
          python -P -m grader check "{submit}" --assignment "{assignment}" --require-level 1 --json --for-student \\
            --output "$RUNNER_TEMP/result.json" || status=$?
          if [ ! -s "$RUNNER_TEMP/result.json" ]; then exit "$status"; fi
          python -P -m grader report "$RUNNER_TEMP/result.json" --format markdown >> "$GITHUB_STEP_SUMMARY"
          python -P -m grader report "$RUNNER_TEMP/result.json" --format junit --output "$RUNNER_TEMP/junit.xml"
          python -P -m grader report "$RUNNER_TEMP/result.json" --format classroom --output "$RUNNER_TEMP/classroom.json"
          echo "result=$(base64 -w0 < "$RUNNER_TEMP/classroom.json")" >> "$GITHUB_OUTPUT"
          python -P -m grader report "$RUNNER_TEMP/result.json"
          exit "$status"
      - uses: actions/upload-artifact@v4
        if: always()
        with:
          name: grade
          path: |
            ${{{{ runner.temp }}}}/result.json
            ${{{{ runner.temp }}}}/junit.xml
  report:
    needs: grade
    if: always() && needs.grade.outputs.result
    runs-on: ubuntu-24.04
    permissions:
      checks: write
    steps:
      - uses: classroom-resources/autograding-grading-reporter@v1
        env:
          GRADE_RESULTS: ${{{{ needs.grade.outputs.result }}}}
        with:
          runners: grade
"""

GITLAB: Final = """\
# Made by `grader ci gitlab`. Grades {submit} on every push.
grade:
  image: python:3.12
  timeout: 15 minutes
  variables:
    GIT_DEPTH: "1"
  script:
    - git clone --quiet --depth 1 {clone} /tmp/kit
    - python -m pip install --quiet -c /tmp/kit/constraints.txt /tmp/kit
    - >-
      python -P -m grader check "{submit}" --assignment "{assignment}" --require-level 1 --json --for-student --output result.json
      || status=$?
    - python -P -m grader report result.json --format junit --output junit.xml
    - python -P -m grader report result.json
    - exit ${{status:-0}}
  artifacts:
    when: always
    paths: [result.json]
    reports:
      junit: junit.xml
"""

WORKFLOWS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {"github": (".github/workflows/grade.yml", GITHUB), "gitlab": (".gitlab-ci.yml", GITLAB)}
)
"""By service: the path of the workflow file, and its text."""


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
            raise ValueError(f"{text}: say https://HOST/PATH, perhaps with @ and a branch or tag after it")
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
    return WORKFLOWS[service][1].format(submit=submit, assignment=assignment, clone=kit.clone)

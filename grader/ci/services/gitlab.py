"""A pipeline of GitLab CI: grades every push."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import Final

from grader.ci.ci_service import CiRunner, CiService, GitSource, GradedWork, lines_of_works

# No cache: GitLab's lies in the checkout, where a student's commit could fill it with what trusted programs then read.
PIPELINE: Final = """\
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


def write(works: Sequence[GradedWork], kit: GitSource, runner: CiRunner) -> bytes:
    """Makes the pipeline."""
    return PIPELINE.format(
        lines=lines_of_works(works, "      "),
        clone=kit.clone,
        python=runner.python,
        minutes=runner.minutes,
    ).encode()


SERVICE: Final = CiService("gitlab", PurePosixPath(".gitlab-ci.yml"), write, is_in_students_repository=True)

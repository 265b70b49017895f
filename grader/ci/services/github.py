"""A workflow of GitHub Actions: grades every push and every pull request of a fork."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath
from types import MappingProxyType
from typing import Final

from grader.ci.ci_service import CiRunner, CiService, GitSource, GradedWork, lines_of_works

ACTIONS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "checkout": "de0fac2e4500dabe0009e67214ff5f5447ce83dd  # v6.0.2",
        "setup_python": "a309ff8b426b58ec0e2a45f0f869d46889d02405  # v6.2.0",
        "cache": "0057852bfaa89a56745cba8c7296529d2fc39830  # v4.3.0",
        "upload_artifact": "043fb46d1a93c77aae656e7c1c64a875d1fc6a0a  # v7.0.1",
    }
)
"""GitHub's own actions, each by the hash of a release, which nobody can move as a tag can be moved."""

WORKFLOW: Final = """\
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


def write(works: Sequence[GradedWork], kit: GitSource, runner: CiRunner) -> bytes:
    """Makes the workflow."""
    return WORKFLOW.format(
        lines=lines_of_works(works, "          "),
        clone=kit.clone,
        python=runner.python,
        runner=runner.image,
        minutes=runner.minutes,
        **ACTIONS,
    ).encode()


SERVICE: Final = CiService(
    "github", PurePosixPath(".github/workflows/grade.yml"), write, is_in_students_repository=True
)

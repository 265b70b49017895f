"""``python -m grader``: the verbs, whose modules in ``grader.cli`` are imported only when a verb is used."""

from __future__ import annotations

import os
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

import click

from kit.cli import LazyGroup

# Before numpy is imported: it starts a thread for each core otherwise, for sums that one adds up in no time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


VERBS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "check": (
            "grader.cli.check:check",
            "Grade one submission: a verdict per criterion, and what to do next.",
        ),
        "new": ("grader.cli.assignments:new", "Make an assignment's folder, to start from."),
        "checks": ("grader.cli.assignments:checks", "List what can be checked, by what is handed in."),
        "self-test": (
            "grader.cli.assignments:self_test",
            "Try an assignment out on its own solution and wrong solutions.",
        ),
        "report": ("grader.cli.check:report", "Write a result in another format."),
        "ci": ("grader.cli.assignments:ci", "Print a workflow file for GitHub or GitLab."),
        "cohort": (
            "grader.cli.cohort:cohort",
            "Grade a folder of submissions; go on where it was interrupted.",
        ),
        "work": ("grader.cli.cohort:work", "Grade a share of a cohort's queue, on another machine."),
        "worker": ("grader.cli.cohort:worker", ""),
        "gradebook": (
            "grader.cli.cohort:gradebook",
            "Print a cohort's gradebook: late rules, and what has changed.",
        ),
        "ladder": ("grader.cli.cohort:ladder", "Race all programs of a folder, and rank them."),
    }
)
"""Where each verb is, and its line, in the order of ``grader --help``."""


@click.group(
    "grader",
    cls=LazyGroup,
    verbs=VERBS,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="`grader VERB --help` explains a verb.",
)
def main() -> None:
    """Grades what students program: one submission here, each push in CI, or a whole class on a cluster."""


if __name__ == "__main__":
    main(prog_name="grader")

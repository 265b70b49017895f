"""``python -m grader``: the commands, whose modules in ``grader.cli`` are imported only when a command is used."""

from __future__ import annotations

import os
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final, NoReturn

import click

from kit.cli.lazy_group import LazyGroup
from kit.cli.process import run_as_process
from kit.extensions import PACKAGES_VARIABLE

# Parts of other packages are loaded where an assignment names them, and nowhere else.
os.environ.setdefault(PACKAGES_VARIABLE, "")


VERBS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "check": (
            "grader.cli.check:check",
            "Grade one submission: the result of each criterion, and what to do next.",
        ),
        "new": ("grader.cli.assignments:new", "Create an assignment from a working example."),
        "release": (
            "grader.cli.handout:release",
            "Make the student's version of an assignment: a folder, a zip or a repository.",
        ),
        "help": ("grader.cli.handout:help_page", "Explain the assignment sheet, key by key."),
        "checks": ("grader.cli.assignments:checks", "List the checks available for each kind of submission."),
        "self-test": (
            "grader.cli.assignments:self_test",
            "Test an assignment on its own solution and wrong solutions.",
        ),
        "report": ("grader.cli.check:report", "Convert a result to another format."),
        "ci": ("grader.cli.ci:ci", "Print a workflow file for GitHub or GitLab."),
        "cohort": (
            "grader.cli.cohort:cohort",
            "Grade a folder of submissions (resumable).",
        ),
        "work": ("grader.cli.cohort:work", "Grade a share of a cohort's queue on another machine."),
        "worker": ("grader.cli.cohort:worker", ""),
        "gradebook": (
            "grader.cli.gradebook:gradebook",
            "The grades of a class: roster, late rules, own marks; for Moodle or Canvas; pages.",
        ),
        "ladder": ("grader.cli.ladder:ladder", "Race all programs in a folder, and rank them."),
    }
)
"""Where each verb is, and its line, in the order of ``grader --help``."""


@click.group(
    "grader",
    cls=LazyGroup,
    verbs=VERBS,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="`grader COMMAND --help` explains a command.",
)
def main() -> None:
    """Grade student programs: one submission, every push in CI, or a whole class on a cluster."""


def run() -> NoReturn:
    """Runs ``grader`` as this process."""
    run_as_process(main, "grader")


if __name__ == "__main__":
    run()

"""What would go wrong with an assignment on a CI service."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from grader.assignment import TEACHERS_STEMS, Assignment
from grader.ci.ci_service import CiService
from kit.host.sandbox.sandbox_config import Level
from kit.plain_text import join_names

HOSTED_LEVEL: Final = Level.FILTERED
"""The highest confinement level of the services' own runners: Ubuntu 24.04's AppArmor and Docker's default profile keep
an ordinary user from making namespaces, which level 2 needs."""


def warnings(assignment: Assignment, service: CiService) -> Iterator[str]:
    """Yields what would go wrong with this assignment on this service, and the way out."""
    found = sorted(
        each.name + "/" * each.is_dir() for each in assignment.folder.iterdir() if each.stem in TEACHERS_STEMS
    )
    if found and service.is_in_students_repository:
        yield (
            f"WARNING: {assignment.folder} contains {join_names(found)}. Anyone who can read the repository can read that. Leave "
            "it out of a repository that students have, and grade with it on your own machine: grader cohort --secret."
        )
        if any(name.startswith("reference") for name in found):
            yield "The checks of this kind compare with the reference: without it they cannot run, in CI neither."
    if assignment.level > HOSTED_LEVEL:
        yield (
            f"WARNING: the assignment asks for confinement level {int(assignment.level)}; the service's own "
            f"runners reach {int(HOSTED_LEVEL)}, so every push would end with exit code 2. Write level: {int(HOSTED_LEVEL)} "
            "in its assignment.yaml, or use a runner of your own on which `kit doctor` shows the level."
        )

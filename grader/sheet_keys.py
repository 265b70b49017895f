"""What each key means that sheets of all kinds have, by its path; ``SubmissionKind.sheet_keys`` has those of one kind.

Types, bounds and defaults are not here: ``grader help sheet`` takes them from the reader itself. A text that says "by default"
takes the place of the reader's default, which is that of the example.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

COMMON_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "title": "What students and gradebooks call the assignment",
        "id": "The name in results and reports, by default that of the folder",
        "kind": "What is handed in",
        "submit": "The name of the file that is handed in",
        "level": "The lowest confinement level at which secret.yaml is used, 0 where nothing that is submitted runs; `kit doctor` lists the levels",
        "checks": "What earns points, in the order in which it is judged",
        "checks.check": "Which check measures it; `grader checks KIND` lists them",
        "checks.id": "Its name in results, by default that of the check; two checks of one name need it",
        "checks.title": "What students read, by default the id",
        "checks.points": "What it is worth",
        "checks.after": "The id of an earlier one that must earn everything first; only those episodes count",
        "checks.on": "The trials that count, by default all",
        "checks.seeds": "The seeds that count",
        "checks.need": "The share of episodes that must earn everything; without it the mean over all episodes counts",
        "checks.with": "Parameters of the check; `grader checks KIND` lists them",
        "checks.visibility": "When a student may see the outcome",
        "checks.hints": "Up to three, from where to look to nearly how",
        "checks.share": "Which measures earn nothing and everything",
        "checks.share.none": "The measure that earns nothing, by default the check's own",
        "checks.share.full": "The measure that earns everything, by default the check's own; between the two lies a straight line",
        "checks.share.steps": "In how many steps points are paid; with secret seeds four unless it is given",
        "checks.mistakes": "Hints for mistakes that can be told by how points were lost; the first that was made comes before the hints",
        "checks.mistakes.hint": "What to say",
        "checks.mistakes.when": "A part of what the feedback says, by default any",
        "checks.mistakes.from": "The least measure for which it is this mistake, by default any",
        "checks.mistakes.to": "The greatest measure for which it is this mistake, by default any",
        "checks.mistakes.passed": "The id of an earlier check that earned everything",
        "tests": 'Your own tests in pytest: files test_*.py in this folder. `@pytest.mark.points(3, after="ID", hints=[...])` says what one is worth, its docstring is the feedback, `grading.evidence("ID")` gives what was driven',
        "budget": "What a program may use: see below",
    }
)

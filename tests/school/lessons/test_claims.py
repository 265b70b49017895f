"""What lessons say is true: each claim is found out again, and each number in a text has something that proves it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from kit.school.lessons.reading import lesson_names
from kit.school.lessons.records import LessonClaim, LessonStep
from tests.cases import every_case
from tests.kit_content import kit_bank, kit_lesson
from tests.school.lessons.derivations import DEAR as FIRST_DEAR
from tests.school.lessons.derivations import DERIVATIONS as FIRST_DERIVATIONS
from tests.school.lessons.practice_derivations import PRACTICE_DEAR, PRACTICE_DERIVATIONS
from tests.school.lessons.system_derivations import SYSTEM_DEAR, SYSTEM_DERIVATIONS
from tests.school.quiz.derivations import DERIVATIONS as QUIZ_DERIVATIONS

DERIVATIONS = {**FIRST_DERIVATIONS, **SYSTEM_DERIVATIONS, **PRACTICE_DERIVATIONS}
DEAR = FIRST_DEAR | SYSTEM_DEAR | PRACTICE_DEAR
LESSONS = [kit_lesson(name) for name in lesson_names()]
CLAIMS = [
    pytest.param(
        step,
        claim,
        id=f"{lesson.name}-{step.number}-{claim.derivation}",
        marks=[pytest.mark.long] if claim.derivation in DEAR else [],
    )
    for lesson in LESSONS
    for step in lesson.steps
    for claim in step.claims
]
STEPS = [pytest.param(step, id=f"{lesson.name}-{step.number}") for lesson in LESSONS for step in lesson.steps]
NUMBER = re.compile(r"(?<![\w.])-?\d[\d,]*(?:\.\d+)?")
NAMES = re.compile(r"lessons? \d+(?: to \d+)?|ROS [12]|Algorithm 3|\b\d:")
"""What holds a number and states nothing: names, and the numbers of a list."""


@pytest.mark.parametrize(("step", "claim"), CLAIMS)
def test_a_claim_is_what_the_kit_does(step: LessonStep, claim: LessonClaim, tmp_path: Path) -> None:
    """Some are what a question of the quiz asks: those are derived there, in ``test_derivations``."""
    if claim.derivation in QUIZ_DERIVATIONS and claim.derivation not in DERIVATIONS:
        assert claim.derivation in {item.derivation for item in kit_bank().items}
        return
    assert DERIVATIONS[claim.derivation](claim.words, step, tmp_path) == claim.words


@every_case("step", STEPS)
def test_each_number_in_a_text_is_proved(step: LessonStep) -> None:
    """By a claim, or because code, commands, scene or the step's exercise hold the same number."""
    known = {_value(number) for number in NUMBER.findall(_code_of(step))}
    prose = _prose_of(step)
    for claim in sorted(step.claims, key=lambda claim: -len(claim.words)):
        prose = prose.replace(claim.words, "")
    prose = NAMES.sub("", re.sub(r"`[^`]*`", "", prose))
    left = [number for number in NUMBER.findall(prose) if not {_value(number), _value(number) / 100} & known]
    assert left == [], "a claim with a derivation must hold each of these"


def test_every_derivation_is_of_use() -> None:
    used = {claim.derivation for lesson in LESSONS for step in lesson.steps for claim in step.claims}
    assert set(DERIVATIONS) <= used
    assert used <= set(DERIVATIONS) | set(QUIZ_DERIVATIONS)
    assert set(DERIVATIONS) >= DEAR


def _value(number: str) -> float:
    return float(number.replace(",", ""))


def _is_code(line: str) -> bool:
    return line.startswith("    ")


def _prose_of(step: LessonStep) -> str:
    texts = [
        step.text,
        step.question,
        *(part for each in step.options for part in (each.text, each.feedback)),
    ]
    lines = [line for text in texts for line in text.splitlines() if not _is_code(line)]
    return " ".join(" ".join(lines).replace("**", "").split())


def _code_of(step: LessonStep) -> str:
    lines = [line for line in step.text.splitlines() if _is_code(line)]
    parts = [*lines, *re.findall(r"`[^`]*`", step.text), step.picture, *(each.line for each in step.commands)]
    if step.scene is not None:
        parts.append(f"{step.scene.seed} {step.scene.seconds}")
    if step.exercise is not None:
        files = (each for each in step.exercise.folder.rglob("*") if each.suffix in (".yaml", ".py", ".dat"))
        parts += [each.read_text() for each in files]
    return "\n".join(parts)

"""A class of made-up students, as files that they could have exported."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from kit.school.form_answers import FormAnswers, asked_questions
from kit.school.form_reading import read_form
from kit.school.progress import FORMAT, VERSION, EventKind, ProgressEvent
from kit.school.quiz.answers import BLANK, NOT_SURE, AnswerChoice, AnswerOccasion, event_content
from kit.school.quiz.items import QuizItem, read_bank
from kit.school.survey import AnswerShape, AnswerValue, SurveyForm, SurveyPhase, SurveyQuestion

START = datetime(2026, 9, 14, 9, 0, tzinfo=UTC)
LESSONS = (("01-drive", "flag"), ("02-nodes-and-topics", "echo"))


the_form = cache(read_form)
the_bank = cache(read_bank)


class Diary:
    """Events of one student, a minute apart."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.events: list[ProgressEvent] = []
        self._time = START

    def note(
        self, kind: EventKind, subject: str, content: dict[str, Any] | None = None, minutes: float = 1
    ) -> None:
        self._time += timedelta(minutes=minutes)
        uid = hashlib.sha256(f"{self.name}/{len(self.events)}".encode()).hexdigest()[:32]
        self.events.append(ProgressEvent(uid, self._time.isoformat(), kind, subject, content or {}))

    def answer(
        self, item: QuizItem, choice: AnswerChoice, occasion: AnswerOccasion = AnswerOccasion.QUIZ
    ) -> None:
        self.note(EventKind.ANSWER, item.id, event_content(item, choice, None, occasion))

    def rate(self, question: str, value: AnswerValue, phase: SurveyPhase = SurveyPhase.AFTER) -> None:
        self.note(EventKind.FORM, question, {"phase": phase.value, "value": value})

    def attempt(self, exercise: str, points: float, verdict: str, lost: Sequence[str] = ()) -> None:
        content = {
            "points": points,
            "max_points": 5.0,
            "verdict": verdict,
            "lost": list(lost),
            "seconds": 1.0,
        }
        self.note(EventKind.ATTEMPT, exercise, content)

    def export(self, folder: Path, file: str | None = None) -> Path:
        path = folder / (file or f"{self.name.lower()}.json")
        path.write_text(export_of(self.events), encoding="utf-8")
        return path


def export_of(events: Sequence[ProgressEvent]) -> str:
    entries = [
        {
            "uid": e.uid,
            "at": e.timestamp,
            "kind": e.kind.value,
            "subject": e.subject,
            "content": dict(e.content),
        }
        for e in events
    ]
    return json.dumps({"format": FORMAT, "version": VERSION, "events": entries})


def student(name: str, skill: float, rng: np.random.Generator) -> Diary:
    """``skill``: 0 to 1. Fills in everything, more or less well."""
    form = the_form()
    diary = Diary(name)
    diary.note(EventKind.ABOUT, "name", {"value": name})
    _fill_in(diary, form, SurveyPhase.BEFORE, skill, rng)
    for lesson, exercise in LESSONS:
        diary.note(EventKind.STEP, f"{lesson}/1")
        diary.note(EventKind.PREDICTION, f"{lesson}/2", {"chosen": 1, "right": bool(rng.random() < skill)})
        while rng.random() > 0.3 + 0.6 * skill:
            diary.attempt(f"{lesson}/{exercise}", 2.0, "fail", ["reached"])
            diary.note(EventKind.HINT, f"{lesson}/{exercise}/reached", {"step": 1})
        diary.attempt(f"{lesson}/{exercise}", 5.0, "pass")
    bank = the_bank()
    for item in bank.quiz_items:
        diary.answer(item, _choice(item, skill, rng))
    for item in bank.quiz_items[:3]:
        diary.answer(item, AnswerChoice(item.right_option), AnswerOccasion.SPACED)
    for item in [each for each in bank.items if not each.idea][:4]:
        diary.answer(item, _choice(item, skill, rng), AnswerOccasion.LESSON)
    _fill_in(diary, form, SurveyPhase.AFTER, min(1.0, skill + 0.3), rng)
    return diary


def _choice(item: QuizItem, skill: float, rng: np.random.Generator) -> AnswerChoice:
    luck = rng.random()
    if luck < 0.2 + 0.7 * skill:
        return AnswerChoice(item.right_option)
    wrong = [option for option in range(len(item.options)) if option != item.right_option]
    return AnswerChoice(int(rng.choice(wrong))) if luck < 0.8 else NOT_SURE if luck < 0.9 else BLANK


def _fill_in(
    diary: Diary, form: SurveyForm, phase: SurveyPhase, level: float, rng: np.random.Generator
) -> None:
    answers, done = FormAnswers(), set[str]()
    while ahead := [each for each in asked_questions(form, answers, phase) if each.id not in done]:
        for question in ahead:
            diary.rate(question.id, _value(question, level, rng), phase)
        done.update(question.id for question in ahead)
        answers = FormAnswers.from_events(form, diary.events)


def _value(question: SurveyQuestion, level: float, rng: np.random.Generator) -> AnswerValue:
    match question.shape:
        case AnswerShape.SCALE:
            blank = rng.random() < 0.02
            return None if blank else int(np.clip(round(1 + 6 * level + rng.normal(0, 1)), 1, 7))
        case AnswerShape.CHOICE:
            return question.options[int(rng.integers(len(question.options)))]
        case AnswerShape.YES_NO:
            return bool(rng.random() < 0.7)
        case AnswerShape.TEXT:
            return "More moving pictures, please." if rng.random() < 0.2 else None


NAMES = ("Ada", "Ben", "Cleo", "Dan", "Eva", "Finn", "Gita", "Hugo", "Ines", "Jon", "Kira", "Leo")


def classroom(folder: Path, count: int = 12, seed: int = 3) -> list[Path]:
    """Files of a class of up to twelve."""
    return [diary.export(folder) for diary in diaries(count, seed)]


def diaries(count: int, seed: int = 3) -> Iterator[Diary]:
    rng = np.random.default_rng(seed)
    for number, name in enumerate(NAMES[:count]):
        yield student(name, number / max(1, count - 1), rng)

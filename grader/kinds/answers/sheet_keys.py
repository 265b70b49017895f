"""What each key means in a sheet of the kind ``answers``, by its path."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

SHEET_KEYS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "questions": "What is asked, by a name of each question",
        "questions.NAME": "One question",
        "questions.NAME.ask": "The question",
        "questions.NAME.choices": "The answers to choose from; without them any text or number",
        "questions.NAME.list": "Whether several answers are asked for: [a, b]",
        "answers": "The right answers, where they need not be secret",
        "answers.NAME": "Those of one question",
        "answers.NAME.right": "Every answer that is right, or with `list` the whole list",
        "answers.NAME.within": "How far a number may be off",
        "answers.NAME.feedback": "What to say to a wrong answer, by that answer",
        "answers.NAME.feedback.NAME": "The sentence for that answer",
        "secret.answers": "In secret.yaml: the right answers",
        "secret.answers.NAME": "Those of one question",
        "secret.answers.NAME.right": "Every answer that is right, or with `list` the whole list",
        "secret.answers.NAME.within": "How far a number may be off",
        "secret.answers.NAME.feedback": "What to say to a wrong answer, by that answer",
        "secret.answers.NAME.feedback.NAME": "The sentence for that answer",
    }
)

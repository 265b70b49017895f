"""The quiz as a dialogue: a question, how sure the student is, and the feedback; nothing moves on by itself."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from enum import Enum
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar, Final

from kit.dialogue.dialogue import Dialogue, DialogueAction, Panel, help_action, leave_action
from kit.dialogue.effects import Effect, Leave
from kit.dialogue.screen_action import ScreenAction, digits, letter
from kit.dialogue.shared_actions import ACTIONS
from kit.document.blocks import (
    Block,
    Choice,
    Choices,
    KeyLine,
    Marked,
    Picture,
    Text,
    Tone,
    ToneText,
    labelled_table,
)
from kit.school.lessons.glossary import glossary_action, lesson_words
from kit.school.lessons.lesson_text import about_lesson
from kit.school.lessons.reading import find_lesson
from kit.school.lessons.records import GraphScene, LearningScene, Lesson, LessonScene, LessonStep
from kit.school.lessons.shell_lines import fill_in_paths
from kit.school.progress import ProgressError
from kit.school.quiz.answers import BLANK, NOT_SURE, AnswerChoice, AnswerOutcome
from kit.school.quiz.items import OPTION_COUNT, QuizItem, lesson_reference
from kit.school.quiz.quiz_scores import measure_calibration
from kit.school.quiz.quiz_session import QuizSession
from kit.school.quiz.quiz_text import (
    CALIBRATION_HEADING,
    CONFIDENCE_CHOICES,
    CONFIDENCE_QUESTION,
    answered_blocks,
    calibration_blocks,
    closing_blocks,
    feedback_text,
    follow_up_blocks,
    round_blocks,
    schedule_blocks,
    today_line,
    topic_map,
    verdict_text,
)
from kit.world.problems import WorldError


class QuizStage(Enum):
    """How far one is with a question."""

    ASKED = "asked"
    CHOSEN = "chosen"
    TOLD = "told"
    OVER = "over"


MARKS: Final = (
    (">", "your choice"),
    ("+", "the right answer"),
    ("x", "your choice, where it is wrong"),
)
KEPT: Final = (
    ("what is kept", "every answer, once you have said how sure you are"),
    ("what comes back", "topics, after 1, 3, 7 and 21 days: kit quiz --today"),
)
ANSWERED: Final = "answered just now"
REASONS: Final = "answered before, and why"
MOST_EARLIER: Final = 6
"""Answers that are listed with their reasons."""
HOW_IT_GOES: Final = (
    Text(
        "Choose an answer, then say how sure you are. Only then is it recorded, and are you told whether it is right."
    ),
    Text("0, not sure, never counts as wrong. Only you can tell a lucky guess from knowledge."),
    *(Text(f"{words[0].upper()}{words[1:]}.", lead=f"{lead}:", lead_tone=Tone.DIM) for lead, words in KEPT),
)
"""What the first question is told beside."""
_TONES: Final = {
    AnswerOutcome.RIGHT: Tone.GOOD,
    AnswerOutcome.WRONG: Tone.BAD,
    AnswerOutcome.NOT_SURE: Tone.BOLD,
    AnswerOutcome.BLANK: Tone.BOLD,
}


def _confidence_line() -> KeyLine:
    choices = tuple(Choice(str(number), text) for number, text in CONFIDENCE_CHOICES)
    return KeyLine(CONFIDENCE_QUESTION, choices)


class QuizDialogue(Dialogue):
    """Asks what a session has ahead."""

    name = "quiz"
    help_title = "The quiz"
    help_notes = (MARKS, KEPT)
    has_scenes = True
    failures = MappingProxyType({ProgressError: "Not saved: {}"})

    def __init__(self, session: QuizSession) -> None:
        self.session = session
        self.item: QuizItem | None = session.current_item
        self.number = session.question_number
        self.choice: AnswerChoice | None = None
        self._lessons: dict[str, Lesson | None] = {}
        """Those that teach what was asked; None: it cannot be read, which is told where it is opened."""
        self.stage = QuizStage.ASKED if self.item is not None else QuizStage.OVER

    # What is shown

    @property
    def title(self) -> str:
        return self.session.plan.title

    @property
    def position(self) -> str:
        if self.item is None or self.is_over:
            return ""
        count = max(self.number, self.session.question_count)
        return f"{self.item.topic.label}, question {self.number} of {count}"

    @property
    def place(self) -> object:
        return None if self.item is None or self.is_over else self.item.id

    @property
    def is_over(self) -> bool:
        return self.stage is QuizStage.OVER

    @property
    def block_in_view(self) -> Block | None:
        is_told = self.stage is QuizStage.TOLD and self.item is not None and self.choice is not None
        return self._feedback(self.item, self.choice)[0] if is_told and self.item and self.choice else None

    def opening(self) -> Sequence[Block]:
        blocks = [Text(f"{self.title}: {self.session.question_count} questions.")]
        if self.number > 1:
            blocks.append(Text(f"You continue at question {self.number}.", is_tight=True))
        return blocks

    def farewell(self) -> Sequence[Block]:
        if self.is_over:
            return ()
        done = f"{self.session.question_number - 1} of {self.session.question_count} answered."
        again = f"`{self.session.plan.command}` continues here."
        return (Text(f"{done} {again} {today_line(self.session.build_schedule())}"),)

    def blocks(self) -> Sequence[Block]:
        item = self.item
        if item is None or self.is_over:
            return closing_blocks(self.session)
        shown = self._question_blocks(item)
        if self.stage is QuizStage.CHOSEN:
            shown.append(_confidence_line())
        elif self.stage is QuizStage.TOLD and self.choice is not None:
            shown += self._feedback(item, self.choice)
        return shown

    def _question_blocks(self, item: QuizItem) -> list[Block]:
        return [Text(item.question), *Picture.of_diagram(item.picture), *self._options(item)]

    def possible_blocks(self) -> Sequence[Sequence[Block]]:
        item = self.item
        if item is None or self.is_over:
            return ()
        asked = self._question_blocks(item)
        choices = (NOT_SURE, BLANK, *map(AnswerChoice, range(len(item.options))))
        return [[*asked, _confidence_line()], *([*asked, *self._feedback(item, each)] for each in choices)]

    has_panels = True

    def panels(self) -> Sequence[Panel]:
        item, session = self.item, self.session
        answers = session.all_answers()
        just_now = Panel(ANSWERED, answered_blocks(session.bank, session.session_answers))
        comes_back = Panel("what comes back, and when", tuple(schedule_blocks(session.build_schedule())))
        known = Panel(
            "what you know, by topic",
            (topic_map(session.bank, answers, None if item is None else item.topic),),
        )
        if item is None or self.is_over:  # the question that was answered last is still the item
            return known, comes_back, just_now
        earlier = [each for each in answers if each.item != item.id][-MOST_EARLIER:]
        reasons = answered_blocks(session.bank, earlier, has_reasons=True)
        last = (
            Panel(f"words of {lesson_reference(item.lesson)}", lesson_words(item.lesson))
            if self.stage is QuizStage.TOLD
            else Panel("how it goes", HOW_IT_GOES)
        )
        return (
            known,
            Panel("these questions", round_blocks(session, self.number)),
            Panel(CALIBRATION_HEADING.lower(), tuple(calibration_blocks(measure_calibration(answers)))),
            comes_back,
            *([last] if last.blocks else []),
            *([Panel(REASONS, reasons, is_below=True)] if reasons else []),
            *self._lesson_panels(item),
        )

    def _lesson_panels(self, item: QuizItem) -> list[Panel]:
        """What the lesson of a question is about, and a picture of another step than the one that teaches the answer; all its
        steps once the answer is told, which their titles may give away."""
        taught = self._taught_by(item)
        if taught is None:
            return []
        lesson, step = taught
        shown = [about_lesson(lesson)]
        pictured = next((each for each in lesson.steps if each.picture and each is not step), None)
        if pictured is not None:
            title = f"lesson {lesson.number}, step {pictured.number}: {pictured.title}"
            picture = Picture.of_diagram(pictured.picture.splitlines())
            shown.append(Panel(title, picture, is_below=True))
        if self.stage is QuizStage.TOLD:
            rows = (
                (
                    ToneText(str(each.number), Tone.DIM),
                    ToneText(each.title, Tone.BOLD if each is step else Tone.PLAIN),
                )
                for each in lesson.steps
            )
            steps = (labelled_table(rows, is_tight=True),)
            shown.append(Panel(f"steps of lesson {lesson.number}", steps, is_below=True))
        return shown

    def _taught_by(self, item: QuizItem) -> tuple[Lesson, LessonStep] | None:
        """The lesson and the step that teach the answer to a question."""
        folder, _, number = item.lesson_to_repeat.partition("/")
        if folder not in self._lessons:
            self._lessons[folder] = None
            with suppress(WorldError, LookupError, OSError):
                self._lessons[folder] = find_lesson(folder)
        lesson = self._lessons[folder]
        return None if lesson is None else (lesson, lesson.steps[int(number or 1) - 1])

    @property
    def scene_shown(self) -> LessonScene | LearningScene | GraphScene | None:
        """What moves in the lesson nearest to where the answer is taught: tables and messages, and a world where the topic is
        about worlds."""
        taught = None if self.item is None or self.is_over else self._taught_by(self.item)
        if self.item is None or taught is None:
            return None
        return taught[0].scene_near(taught[1].number, has_worlds=self.item.topic.has_worlds)

    def figure(self) -> Panel | None:
        """Once the answer is told, the step that teaches it."""
        if (
            self.item is None
            or self.stage is not QuizStage.TOLD
            or (taught := self._taught_by(self.item)) is None
        ):
            return None
        lesson, step = taught
        picture = Picture.of_diagram(step.picture.splitlines())
        title = f"lesson {lesson.number}, step {step.number}: {step.title}"
        file = None if step.exercise is None else Path(step.exercise.file)
        return Panel(title, (*picture, Marked(fill_in_paths(step.text, file))))

    def _options(self, item: QuizItem) -> list[Block]:
        """``>`` before the chosen one; once it is told, ``+`` before the right and ``x`` before a wrong one."""
        told, is_asked, entries = self.stage is QuizStage.TOLD, self.stage is QuizStage.ASKED, []
        for index, option in enumerate(item.options):
            is_chosen = self.choice is not None and self.choice.option == index
            mark, tone = (">", Tone.BOLD) if is_chosen else (" ", Tone.PLAIN)
            if told and option.is_right:
                mark, tone = "+", Tone.GOOD
            elif told:
                mark, tone = ("x", Tone.BAD) if is_chosen else (" ", Tone.DIM)
            entries.append(Choice(str(index + 1), option.text, tone, mark, is_asked))
        not_sure = Choices((Choice("0", "I am not sure", Tone.DIM, is_open=is_asked),), is_tight=True)
        return [Choices(tuple(entries)), *([] if told else [not_sure])]

    def _feedback(self, item: QuizItem, choice: AnswerChoice) -> list[Block]:
        return [
            Text(verdict_text(item, choice), _TONES[choice.outcome_for(item)]),
            Text(feedback_text(item, choice), is_tight=True),
            *follow_up_blocks(item),
        ]

    # What is done

    def choose(self, number: int) -> Effect:
        self.choice = AnswerChoice(number - 1)
        self.stage = QuizStage.CHOSEN
        return None

    def rate(self, confidence: int) -> Effect:
        assert self.choice is not None
        return self._save(self.choice, confidence)

    def say_not_sure(self) -> Effect:
        return self._save(NOT_SURE)

    def leave_blank(self) -> Effect:
        return self._save(BLANK)

    def _save(self, choice: AnswerChoice, confidence: int | None = None) -> Effect:
        """The answer goes to the disk; only then is anything said of it."""
        self.session.answer(choice, confidence)
        self.choice = choice
        self.stage = QuizStage.TOLD
        return None

    def take_back(self) -> Effect:
        self.choice = None
        self.stage = QuizStage.ASKED
        return None

    def go_on(self) -> Effect:
        if self.is_over:
            return Leave()
        self.item, self.number = self.session.current_item, self.session.question_number
        self.choice = None
        self.stage = QuizStage.OVER if self.item is None else QuizStage.ASKED
        return None

    # When

    def is_asked(self) -> bool:
        return self.stage is QuizStage.ASKED

    def is_chosen(self) -> bool:
        return self.stage is QuizStage.CHOSEN

    def can_go_on(self) -> bool | str:
        match self.stage:
            case QuizStage.ASKED:
                return (
                    f"Choose 1 to {OPTION_COUNT}; 0 says that you are not sure, x leaves the question blank."
                )
            case QuizStage.CHOSEN:
                return f"Say how sure you are: 1 to {len(CONFIDENCE_CHOICES)}; b changes the answer."
            case _:
                return True

    def next_word(self) -> str:
        if self.is_over:
            return "close"
        return "results" if self.session.current_item is None else "next"

    actions: ClassVar[Sequence[DialogueAction[Any]]] = (
        DialogueAction(
            ScreenAction("answer", "1 2 3", "answer", "choose an answer, then say how sure you are", digits("answer", 1, OPTION_COUNT), "1-3"),
            choose, is_asked,
        ),
        DialogueAction(
            ScreenAction("confidence", "1 2 3 4", "how sure", "say how sure you are of your answer", digits("confidence", 1, 4), "1-4"),
            rate, is_chosen, then="next",
        ),
        DialogueAction(
            ScreenAction("not_sure", "0", "not sure", "say that you do not know; not counted as wrong", (("0", "not_sure"),)),
            say_not_sure, is_asked, then="next",
        ),
        DialogueAction(
            letter("skip", "x", "blank (twice)", "leave the question blank; press it twice"),
            leave_blank, is_asked, confirm="x once more leaves it blank; 0 says that you are not sure.", then="next",
        ),
        DialogueAction(ACTIONS["next"], go_on, can_go_on, word=next_word),
        DialogueAction(ACTIONS["previous"], take_back, is_chosen),
        help_action(),
        leave_action(),
        glossary_action(),
    )  # fmt: skip

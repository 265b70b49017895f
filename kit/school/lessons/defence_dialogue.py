"""The defence as a dialogue: what will the student's own program do from here? Three answers first, and then the run is seen."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType
from typing import Any, ClassVar

from kit.dialogue.dialogue import Dialogue, DialogueAction, Refused, leave_action
from kit.dialogue.effects import Effect
from kit.dialogue.screen_action import ScreenAction, digits
from kit.dialogue.shared_actions import ACTIONS
from kit.document.blocks import Block, Choice, Choices, Text, Tone
from kit.geometry import whole_degrees
from kit.plain_text import counted
from kit.school.lessons.defence import Defence, DefenceQuestion
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.records import Exercise
from kit.school.lessons.stage import NoStage, RunStage
from kit.school.progress import ProgressError


class DefenceDialogue(Dialogue):
    """Asks about the student's own program, and shows the run once every question is answered."""

    name = "defence"
    help_title = "Defend your program"
    failures = MappingProxyType({ProgressError: "This could not be saved: {}"})

    def __init__(self, session: LessonSession, exercise: Exercise, defence: Defence) -> None:
        self.defence = defence
        self.answers: list[int] = []
        self.stage: RunStage = NoStage()
        self._session = session
        self._exercise = exercise

    def open_stage(self, stage: RunStage) -> None:
        """Shows where the robot starts."""
        self.stage = stage
        stage.play(self.defence.recording, self.defence.place, still=True)

    # What is shown

    @property
    def title(self) -> str:
        return f"Defend your program: {self._exercise.name}"

    @property
    def position(self) -> str:
        return (
            "" if self.is_answered else f"question {len(self.answers) + 1} of {len(self.defence.questions)}"
        )

    @property
    def place(self) -> object:
        return len(self.answers)

    @property
    def is_answered(self) -> bool:
        """Whether nothing is left to ask."""
        return len(self.answers) == len(self.defence.questions)

    @property
    def is_over(self) -> bool:
        return self.is_answered

    def opening(self) -> Sequence[Block]:
        x, y, theta = self.defence.start
        return (Text(f"The robot starts at x {x:.2f}, y {y:.2f}, heading {whole_degrees(theta)} degrees."),)

    def blocks(self) -> Sequence[Block]:
        if self.is_answered:
            return self._outcome()
        question = self.defence.questions[len(self.answers)]
        options = tuple(Choice(str(number), text) for number, text in enumerate(question.options, 1))
        return (Text(question.text, Tone.BOLD), Choices(options, is_tight=True))

    def _outcome(self) -> list[Block]:
        blocks: list[Block] = []
        for question, answer in zip(self.defence.questions, self.answers, strict=True):
            blocks += [Text(question.text, is_tight=True), _answer_text(question, answer)]
        right, count = self.defence.right_count(self.answers), len(self.answers)
        if right == count:
            return [*blocks, Text("All correct: one more star. You know your program.", Tone.GOOD)]
        said = f"{right} of {counted(count, 'answer')} right. Another start is asked about next time."
        return [*blocks, Text(said, Tone.BOLD)]

    # What is done

    def choose(self, number: int) -> Effect:
        count = len(self.defence.questions[len(self.answers)].options)
        if number > count:
            raise Refused(f"Choose 1 to {count}.")
        self.answers.append(number - 1)
        if self.is_answered:
            self.stage.go()
            self._session.record_defence(self._exercise, self.defence, self.answers)
        return None

    def show_again(self) -> Effect:
        self.stage.replay()
        return None

    def is_asked(self) -> bool:
        return not self.is_answered

    def answer_keys(self) -> str:
        return f"1-{len(self.defence.questions[len(self.answers)].options)}"

    actions: ClassVar[Sequence[DialogueAction[Any]]] = (
        DialogueAction(
            ScreenAction("defence_answer", "1 2 3", "answer", "choose an answer; it counts", digits("answer", 1, 3), "1-3"),
            choose, is_asked, shown_keys=answer_keys,
        ),
        DialogueAction(ACTIONS["restart"], show_again, lambda dialogue: dialogue.is_answered, is_for_lines=False),
        leave_action(),
    )  # fmt: skip


def _answer_text(question: DefenceQuestion, answer: int) -> Text:
    if answer == question.right:
        return Text(f"+ {question.options[answer]}", Tone.GOOD, is_tight=True)
    text = f"x {question.options[answer]} Correct: {question.options[question.right]}"
    return Text(text, Tone.BAD, is_tight=True)

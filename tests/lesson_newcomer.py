"""A scripted newcomer in front of a lesson: reads what stands there, and uses the keys, files and commands it names.

One on the full screen, one line by line; both in a real terminal of 80x24. What they answer and hand in is right.
"""

from __future__ import annotations

import math
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Final

from kit.document.markup import parse_markup, plain_text, wrap_blocks
from kit.school.game.levels import levels_of_lesson
from kit.school.lessons.checking import exercise_folder
from kit.school.lessons.lesson_dialogue import LessonDialogue
from kit.school.lessons.reading import TEXT_WIDTH, lesson_names, lessons_folder, read_lesson, solutions_folder
from kit.school.lessons.records import CommandKind, Exercise, Lesson, LessonCommand, LessonStep
from kit.school.lessons.shell_lines import fill_in_paths
from kit.school.quiz.items import QuizItem, read_bank
from kit.school.quiz.quiz_dialogue import QuizDialogue
from kit.tui.screens.dialogue import screen_actions_of
from kit.workspace import Workspace
from tests.tui.test_play_pty import User

ACTIONS: Final = {
    each.id: each
    for actions in map(screen_actions_of, (LessonDialogue, QuizDialogue))
    for each in actions.records
}
LIMIT_S: Final = 300.0
"""A machine beside other work takes that long for a check that trains."""
TOLD_S: Final = 1.0
"""How long one looks at a scene before one presses the key that goes on."""
SETTLING_READS, SETTLED_S = 10, 0.3
"""So often a screen is looked at, for so long each time [s], until nothing of it changes."""
ROW_END: Final = 20
"""Characters by which a row of text is known."""
MORE: Final = re.compile(r"\.\.\. (\d+) more lines")
KEYS: Final = {"Esc": "\x1b", "Enter": "\r", "^C": "\x03"}
"""What a terminal sends for a key that has no character."""
LIST_KEYS: Final = "arrows choose, Enter confirm"
UP, LEFT, RIGHT = "A", "D", "C"
WAY_TO_FLAG: Final = ((1.0, 0.0), (1.0, 1.9), (3.0, 1.9))
"""That of the exercise's last hint: x and y [m]."""
NEAR_M: Final = 0.12
AIMED_DEG: Final = 5.0
ON_WAY_M: Final = 0.35
"""Further off a corner than this, the way is left."""
DRIVES: Final = 20
"""To the target, before it is given up."""
PLAIN_WAY_TO_FLAG: Final = ("0 1 1.571", "0.5 0 2", "0 1 1.571", "0.5 0 3.8", "0 -1 1.571", "0.5 0 4")
"""The same as speed, turning and seconds."""
TELEOP_KEYS: Final = "/teleopkeys"
"""The topic on which there is something to hear once a key is pressed."""
ENDLESS: Final = ("echo", "hz", "bw")
"""Words of verbs that listen until Ctrl-C."""


def right_number(step: LessonStep) -> int:
    """The number of the right prediction, counted from 1."""
    return 1 + next(number for number, option in enumerate(step.options) if option.is_right)


def as_a_shell_reads(text: str) -> str:
    """With lines joined that end in a backslash, and single blanks."""
    return " ".join(text.replace("\\\n", "").split())


def without_blanks(text: str) -> str:
    """What is left of a text however its lines are broken."""
    return re.sub(r"\\\n|\s", "", text)


def put_solution(file: Path, lesson: Lesson, exercise: Exercise) -> None:
    """Writes the reference solution over the student's files. ``file``: the one that the exercise names."""
    found = solutions_folder() / lesson.name / exercise.name
    single = found / f"solution{Path(exercise.file).suffix}"
    if single.is_file():
        file.write_bytes(single.read_bytes())
        return
    whole = found / "solution"
    folder = file
    for _ in Path(exercise.edited_first or exercise.file).parts:
        folder = folder.parent
    for each in sorted(whole.rglob("*")):
        if each.is_file() and "__pycache__" not in each.parts:
            to = folder / each.relative_to(whole)
            to.parent.mkdir(parents=True, exist_ok=True)
            to.write_bytes(each.read_bytes())


class Newcomer(ABC):
    """``walk`` goes from the first step of a lesson to its end."""

    def __init__(
        self,
        open_terminal: Callable[..., User],
        workspace: Workspace,
        lesson: Lesson,
        commands: Collection[LessonCommand] = (),
    ) -> None:
        """``commands``: those to run; all others are only to be read."""
        self._open_terminal = open_terminal
        self._workspace = workspace
        self.lesson = lesson
        self._commands = commands
        self.user = open_terminal("lesson", lesson.name, *self.options)

    options: Sequence[str] = ()

    def walk(self) -> None:
        for step in self.lesson.steps:
            read = as_a_shell_reads(self.read(step))
            if step.options:
                self.predict(step)
            exercise = step.exercise
            file = self.file_of(step)
            if exercise is not None and file is not None:
                named = self.named_file()
                assert named == file.parent / (exercise.edited_first or exercise.file)
                if exercise.is_driven:
                    self.drive()
                else:
                    self.check(lambda: put_solution(named, self.lesson, exercise))  # noqa: B023 - called at once
            unread = [each.line for each in step.commands if fill_in_paths(each.line, file) not in read]
            assert unread == [], f"step {step.number} shows other commands:\n{read}"
            self.run_commands(step, file)
            self.go_on(step)
        self.end()

    def file_of(self, step: LessonStep) -> Path | None:
        """The file to hand in; None for a step without an exercise."""
        if step.exercise is None:
            return None
        return exercise_folder(self._workspace, self.lesson, step.exercise) / step.exercise.file

    def words_of(self, step: LessonStep) -> str:
        """The step's text, with the student's own paths."""
        return fill_in_paths(step.text, self.file_of(step))

    def wait(self, condition: Callable[[], object], what: str) -> None:
        end = time.monotonic() + LIMIT_S
        while not condition():
            assert time.monotonic() < end, f"waited in vain for {what}:\n{self.user.text}"
            assert self.user.process.poll() is None, f"it ended before {what}:\n{self.user.text}"
            self.user.pump(0.05)

    @abstractmethod
    def read(self, step: LessonStep) -> str:
        """All that a step says, from its beginning."""

    @abstractmethod
    def named_file(self) -> Path:
        """The file to edit, as it is named."""

    @abstractmethod
    def predict(self, step: LessonStep) -> None: ...

    @abstractmethod
    def check(self, work: Callable[[], None]) -> None:
        """Hands in what ``work`` writes, and sees that it passes."""

    @abstractmethod
    def drive(self) -> None:
        """Drives to the flag."""

    @abstractmethod
    def run_commands(self, step: LessonStep, file: Path | None) -> None: ...

    @abstractmethod
    def go_on(self, step: LessonStep) -> None: ...

    @abstractmethod
    def end(self) -> None:
        """Sees what is said after the last step, answers the lesson's questions, and leaves."""


class ScreenNewcomer(Newcomer):
    """On the full screen."""

    @property
    def rows(self) -> list[str]:
        return self.user.text.splitlines()

    @property
    def footer(self) -> str:
        return self.rows[-1]

    def shows(self, action: str) -> bool:
        """Whether the row of keys names an action."""
        return self.names_key(f"{ACTIONS[action].footer_keys} {ACTIONS[action].label}")

    def names_key(self, words: str) -> bool:
        """Whether keys and their words stand in the row of keys."""
        return f" {words} " in f" {self.footer} "

    def press(self, action: str) -> None:
        """Presses the key of an action, once the row of keys names it."""
        keys = ACTIONS[action].footer_keys
        self.wait(lambda: self.shows(action), f"{keys} in the row of keys")
        self.type(KEYS.get(keys, keys))

    def type(self, keys: str) -> None:
        self.user.send(keys.encode())

    def is_at(self, number: int) -> bool:
        return (
            f" step {number} of {len(self.lesson.steps)} " in f"{self.rows[0]} "
        )  # the bar gives way to a long goal

    def read(self, step: LessonStep) -> str:
        rows = [plain_text(each) for each in wrap_blocks(parse_markup(self.words_of(step)), TEXT_WIDTH)]
        ends = [without_blanks(row)[-ROW_END:] for row in rows]

        def is_painted() -> bool:
            """A terminal shows a new page bit by bit."""
            text = without_blanks(self.user.text)
            is_whole = all(end in text for end in ends) or (MORE.search(self.user.text) and ends[0] in text)
            return self.is_at(step.number) and step.title in self.rows[1] and bool(is_whole)

        self.wait(is_painted, f"step {step.number}")
        pages = [self._settled_text()]
        while more := MORE.search(pages[-1]):
            self.type("\x1b[6~")
            self.wait(lambda before=more[0]: before not in self.user.text, "the next page")  # type: ignore[misc]  # mypy on lambdas
            pages.append(self._settled_text())
        return "\n".join(pages)

    def _settled_text(self) -> str:
        """The screen once no more of it comes; where something moves all the time, as it is after a while."""
        for _ in range(SETTLING_READS):
            before = self.user.text
            self.user.pump(SETTLED_S)
            if self.user.text == before:
                break
        return self.user.text

    def named_file(self) -> Path:
        heads = (" Edit ", " Saved in ")
        self.wait(lambda: any(row.startswith(heads) for row in self.rows), "the name of the file")
        at, head = next(
            (at, head) for at, row in enumerate(self.rows) for head in heads if row.startswith(head)
        )
        name = self.rows[at]
        for row in self.rows[at + 1 :]:
            if not row.startswith(" " * len(head)):
                break
            name += row.strip()
        name = name.removeprefix(head).removesuffix("and the files beside it").rstrip(", ")
        return Path(*shlex.split(name)).expanduser()

    def predict(self, step: LessonStep) -> None:
        count = len(step.options)
        self.wait(lambda: self.names_key(f"1-{count} predict"), "the keys of the prediction")
        self.type(str(right_number(step)))
        self.wait(lambda: self.shows("next"), "the prediction to be kept")
        end = time.monotonic() + TOLD_S
        while "Right." not in self.user.text and time.monotonic() < end:
            self.user.pump(0.05)
        if "Right." not in self.user.text:
            self.press("next")  # nobody need wait for the end of a scene
            self.wait(lambda: "Right." in self.user.text or self.is_at(step.number + 1), "what is said to it")

    def check(self, work: Callable[[], None]) -> None:
        self.wait(lambda: self.shows("check"), "the key of the check")
        work()
        self.type(ACTIONS["check"].footer_keys)
        self._see_it_pass()

    def _see_it_pass(self) -> None:
        self.wait(
            lambda: re.search(
                r"^ +(Passed: |Not yet: |Not checked|The check (itself|could|did|broke))",
                self.user.text,
                re.M,
            ),
            "the verdict",
        )
        assert "\n  Passed: " in self.user.text, self.user.text

    def drive(self) -> None:
        self.press("drive")
        self.wait(lambda: "The clock starts with your first key." in self.user.text, "the drive")
        for _ in range(DRIVES):
            if self._drive_way():
                break
            self.press("restart")
            self.wait(self._is_at_start, "the start again")
        self.wait(lambda: "The target is reached" in self.user.text, "the flag")
        self.type(KEYS["Esc"])
        self.wait(lambda: self.is_at(self._drive_step), "the lesson again")
        self._see_it_pass()

    def _drive_way(self) -> bool:
        """Whether it led to the flag. A busy machine shows the pose late: too far, and into a wall."""
        for x, y in WAY_TO_FLAG:
            self._turn_towards(x, y)
            self._drive_to(x, y)
            here_x, here_y, _ = self._pose()
            if math.hypot(x - here_x, y - here_y) > ON_WAY_M:
                break
        end = time.monotonic() + TOLD_S
        while "The target is reached" not in self.user.text and time.monotonic() < end:
            self.user.pump(0.05)
        return "The target is reached" in self.user.text

    def _is_at_start(self) -> bool:
        x, y, _ = self._pose()
        return math.hypot(x, y) < NEAR_M

    @property
    def _drive_step(self) -> int:
        return next(step.number for step in self.lesson.steps if step.exercise and step.exercise.is_driven)

    def _pose(self) -> tuple[float, float, float]:
        """What the panel says: x and y [m], heading [degrees]."""
        found = re.search(
            r"\bx +(-?[\d.]+) m.*?\by +(-?[\d.]+) m.*?heading +(-?\d+)", self.user.text, re.DOTALL
        )
        assert found, self.user.text
        return float(found[1]), float(found[2]), float(found[3])

    def _hold(self, arrow: str, is_there: Callable[[], bool]) -> None:
        self.type(f"\x1b[1;1:1{arrow}")
        pressed = time.monotonic()

        def is_done() -> bool:
            nonlocal pressed
            if "The clock starts with your first key" in self.user.text:
                if time.monotonic() - pressed < TOLD_S:  # a held key repeats, as a terminal's does
                    self.type(f"\x1b[1;1:2{arrow}")
                else:  # it was pressed before the drive took keys: one presses again
                    self.type(f"\x1b[1;1:3{arrow}\x1b[1;1:1{arrow}")
                    pressed = time.monotonic()
            return is_there() or "The target is reached" in self.user.text

        self.wait(is_done, "the robot there")
        self.type(f"\x1b[1;1:3{arrow}")
        self.wait(
            lambda: (
                (
                    re.search(r"forward +-?0\.00", self.user.text)
                    and re.search(r"turning +-?0\.00", self.user.text)
                )
                or "The target is reached" in self.user.text
            ),
            "the robot to stand",
        )

    def _turn_towards(self, x: float, y: float) -> None:
        def off() -> float:
            here_x, here_y, heading = self._pose()
            return math.remainder(math.degrees(math.atan2(y - here_y, x - here_x)) - heading, 360.0)

        while abs(error := off()) > AIMED_DEG:
            side = math.copysign(1.0, error)
            self._hold(LEFT if side > 0 else RIGHT, lambda side=side: side * off() < AIMED_DEG)  # type: ignore[misc]  # mypy on lambdas

    def _drive_to(self, x: float, y: float) -> None:
        def to_go() -> float:
            here_x, here_y, _ = self._pose()
            return math.hypot(x - here_x, y - here_y)

        nearest = math.inf

        def is_there() -> bool:
            nonlocal nearest
            nearest = min(nearest, to_go())
            return to_go() < NEAR_M or to_go() > nearest + NEAR_M

        self._hold(UP, is_there)

    def run_commands(self, step: LessonStep, file: Path | None) -> None:
        """Each in this terminal; those that ask a world in a second one, while that world is open here."""
        runnable = step.runnable_commands
        for at, command in enumerate(runnable):
            asked = [
                each
                for each in step.commands
                if each.kind is CommandKind.BESIDE
                and each in self._commands
                and command.kind is CommandKind.SCREEN
                and command.line == f"kit drive {each.map_name}"
            ]
            if not asked and command not in self._commands:
                continue
            began = len(self.user.output)
            self.press("run_command")
            if len(runnable) > 1:
                self.wait(lambda: LIST_KEYS in self.user.text, "the list of commands")
                self.type("\x1b[B" * at + "\r")
            self.wait(lambda: b"$ kit" in self.user.output[began:], f"{command.line} to run")  # noqa: B023 - called at once
            if command.kind is CommandKind.SCREEN:
                self._look_at_screen([fill_in_paths(each.line, file) for each in asked], began)
            else:
                self._read_output(began)
            self.wait(
                lambda: (
                    self.user.modes.alternate and self.is_at(step.number) and LIST_KEYS not in self.user.text
                ),
                "the lesson again",
            )
            assert b"Traceback" not in self.user.output[began:]

    def _read_output(self, began: int) -> None:
        """What a command printed, on a page of its own. A training has a screen of its own, which is left once it has
        finished."""

        def has_finished() -> bool:
            return self.user.modes.alternate and " finished " in f"{self.rows[0]} "

        def is_told() -> bool:
            return self.user.modes.alternate and self.rows[0].startswith(("kit ", "grader "))

        self.wait(lambda: is_told() or has_finished(), "the end of the command")
        if has_finished():
            self.type(KEYS["Esc"])
        else:
            self.press("back")

    def _look_at_screen(self, asked: Sequence[str], began: int) -> None:
        """Opens, answers from a second terminal, and is left with Ctrl-C."""
        self.wait(
            lambda: b"\x1b[?1049h" in self.user.output[began:] and "$ kit" not in self.user.text,
            "the screen of the command",
        )
        if asked:
            self.wait(lambda: "heading" in self.user.text, "the world")
        for line in asked:
            self._ask(line)
        self.type(KEYS["^C"])
        self.wait(lambda: self.user.output[began:].count(b"\x1b[?1049h") > 1, "the lesson again")

    def _ask(self, line: str) -> None:
        """Types a command into a second terminal while the world goes on in this one."""
        program, *arguments = shlex.split(line)
        is_endless = any(word in ENDLESS for word in arguments) and "--once" not in arguments
        end = time.monotonic() + LIMIT_S
        while True:
            asking = subprocess.Popen(
                [sys.executable, "-m", program, *arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env=os.environ,
            )
            assert asking.stdout is not None
            os.set_blocking(asking.stdout.fileno(), False)
            heard = b""
            while asking.poll() is None and not (is_endless and heard):
                assert time.monotonic() < end, f"{line} said nothing"
                if TELEOP_KEYS in arguments:
                    self.type(f"\x1b[1;1:1{UP}\x1b[1;1:3{UP}")
                self.user.pump(0.2)
                heard += asking.stdout.read() or b""
            if asking.poll() is None:
                asking.send_signal(signal.SIGINT)
            _, error = asking.communicate(timeout=LIMIT_S)
            if error != b"Node not found\n":  # the world is up before its controller
                break
        # A shell says 130 as well of what ends by the signal itself.
        assert asking.returncode in ((0, 130, -signal.SIGINT) if is_endless else (0,)), (
            f"{line}: {asking.returncode}\n{error.decode()}"
        )
        assert b"Traceback" not in error

    def go_on(self, step: LessonStep) -> None:
        if step.number == len(self.lesson.steps) or not self.is_at(step.number + 1):
            self.press("next")

    def end(self) -> None:
        following = self._see_what_follows()
        self.press("questions")
        items = read_bank().lesson_items(self.lesson.name)
        for number in range(1, len(items) + 1):
            self.wait(
                lambda number=number: f"question {number} of {len(items)}" in self.rows[0],  # type: ignore[misc]  # mypy on lambdas
                f"question {number}",
            )
            self._answer(items)
        self.wait(lambda: "How sure, and how often" in self.user.text, "the results")
        self.press("back")
        assert self._see_what_follows() == following
        if following:
            self.type(KEYS["Enter"])
            self.wait(
                lambda: " step 1 of " in self.rows[0] and self.rows[0].startswith(following),
                f"the next lesson, {following}",
            )
        self.type(KEYS["^C"])
        assert self.user.wait() == 0
        self.user.assert_sane()

    def _see_what_follows(self) -> str:
        """The number of the next lesson, as the page after the last step names it; empty after the last lesson."""
        self.wait(
            lambda: (
                f"{self.lesson.title} is done." in self.user.text
                and not missing_follow_ups(self.lesson, as_a_shell_reads(self.user.text))
            ),
            "the end, what it opens and the lesson that follows",
        )
        text = as_a_shell_reads(self.user.text)
        found = re.search(r"Enter opens the next lesson, (\S+) ", text)
        return found[1] if found else ""

    def _answer(self, items: Sequence[QuizItem]) -> None:
        """A question of the quiz, rightly and without a doubt."""
        # The lowest row is painted last: until it names the keys, half of the page may be the question before.
        self.wait(lambda: self.shows("answer"), "the keys of the answers")
        item = asked_item(items, as_a_shell_reads(self.user.text))
        self.type(number_of_option(item, self.rows))
        self.wait(lambda: self.shows("confidence"), "how sure")
        self.type("4")
        self.wait(lambda: "Right." in self.user.text, "what is said to the answer")
        self.wait(
            lambda: re.search(r"\bn (next|results) ", f"{self.footer} "), "the key of the next question"
        )
        self.type("n")


class LineNewcomer(Newcomer):
    """Line by line."""

    options = ("--plain",)
    _keys = ""
    """What can be typed, as it was last said: it is said again when it changes."""

    def read(self, step: LessonStep) -> str:
        if step.number == 1:
            self._said = self._hear(0)
        count = len(self.lesson.steps)
        said = " ".join(self._said.split())
        assert f"Step {step.number} of {count}, {step.kind}: {step.title}" in said, self._said
        return self._said

    def _hear(self, since: int) -> str:
        """What is said until the next line may be typed."""
        self.wait(lambda: self.user.output[since:].endswith(b"\n> "), "the prompt")
        said = self.user.output[since:].decode().replace("\r\n", "\n")
        self._keys = next((part for part in reversed(said.split("\n\n")) if "? help" in part), self._keys)
        return said

    def type(self, line: str) -> str:
        """Types a line; returns what is said to it."""
        since = len(self.user.output)
        self.user.send(f"{line}\n".encode())
        return self._hear(since)

    def press(self, action: str) -> str:
        """Types the letter of an action, which must have been named."""
        found = ACTIONS[action]
        letter = found.keys.split()[0]
        assert re.search(rf"(^|\s){re.escape(letter)} {found.label}\b", self._keys), self._keys
        return self.type(letter)

    def named_file(self) -> Path:
        found = re.search(r"^Your file: (.+?)(, and the files beside it)?$", self._said, re.MULTILINE)
        assert found, self._said
        return Path(*shlex.split(found[1])).expanduser()

    def predict(self, step: LessonStep) -> None:
        assert f"1-{len(step.options)} predict" in self._keys
        self._said = self.type(str(right_number(step)))
        assert "Right." in self._said, self._said

    def check(self, work: Callable[[], None]) -> None:
        work()
        said = self.press("check")
        assert "Passed: ***" in said, said

    def drive(self) -> None:
        said = self.press("drive")
        assert "`drive 0.3 0 2` drives" in said
        for leg in PLAIN_WAY_TO_FLAG:
            said = self.type(f"drive {leg}")
        assert "target reached" in said, said
        said = self.type("quit")
        assert "Passed: ***" in said, said

    def run_commands(self, step: LessonStep, file: Path | None) -> None:
        """They are run in the form on the full screen; here they are only read."""

    def go_on(self, step: LessonStep) -> None:
        if step.number < len(self.lesson.steps):
            self._said = self.press("next")

    def end(self) -> None:
        self._said = said = self.type("n")
        assert f"{self.lesson.title} is done." in said, said
        assert missing_follow_ups(self.lesson, as_a_shell_reads(said)) == []
        items = read_bank().lesson_items(self.lesson.name)
        said = self.press("questions")
        for _ in items:
            item = asked_item(items, as_a_shell_reads(said))
            assert "How sure are you?" in self.type(number_of_option(item, said.splitlines()))
            said = self.type("4")
        assert "How sure, and how often" in said
        self.user.send(b"q\n")
        assert self.user.wait() == 0


def as_shown(text: str) -> str:
    """Words as they stand in a row, without the marks of code, which screens replace by a tone."""
    return " ".join(text.replace("`", "").split())


def asked_item(items: Sequence[QuizItem], text: str) -> QuizItem:
    """The question that stands in a text. Two may have the same words, but not the same picture and options."""
    text = as_shown(text)
    return next(
        each
        for each in items
        if as_shown(each.question)[:60] in text
        and as_shown(" ".join(each.picture)) in text
        and all(as_shown(option.text)[:20] in text for option in each.options)
    )


def number_of_option(item: QuizItem, rows: Sequence[str]) -> str:
    """The number that stands before the right answer."""
    right = as_shown(item.options[item.right_option].text)
    found = (re.match(r"\s*(\d)  (\S.*)$", row) for row in rows)
    return next(each[1] for each in found if each and right.startswith(as_shown(each[2])))


def missing_follow_ups(lesson: Lesson, text: str) -> list[str]:
    """What the end of a lesson should name and this text does not: the next lesson, and the levels that it opens."""
    names = lesson_names()
    following = [read_lesson(lessons_folder() / name) for name in names[names.index(lesson.name) + 1 :][:1]]
    wanted = [f"{each.number} {each.title}" for each in following]
    return [
        each
        for each in (*wanted, *(level.title for level in levels_of_lesson(lesson.name)))
        if each not in text
    ]

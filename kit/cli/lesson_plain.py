"""A lesson line by line: for screen readers, pipes, and terminals without a full screen."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Final, NamedTuple

import click

from kit.cli.waiting import Intake, Lines
from kit.host.file_watcher import FileWatcher
from kit.school.lessons.checking import CheckReport, submission_path
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.markup import parse_markup, plain_text, wrap_blocks
from kit.school.lessons.reading import TEXT_WIDTH
from kit.school.lessons.records import Exercise, LessonCommand, LessonScene, LessonStep, StepKind
from kit.school.result_text import criterion_lines, points_text, replay_lines
from kit.school.result_text import line_text as plain_line

LOOK_S: Final = 0.2
"""How often to look whether the student's file was saved."""
PICTURE_ROWS: Final = 12


class Mistake(Exception):
    """A line that cannot be done; the message says why."""


class Verb(NamedTuple):
    text: str
    do: Callable[[PlainLesson, str], None]
    fits: Callable[[PlainLesson], bool]
    """Whether it can be said now."""


class PlainLesson:
    """One lesson, driven by lines of text."""

    def __init__(
        self,
        session: LessonSession,
        *,
        watch: Callable[[LessonScene], None],
        drive: Callable[[LessonScene, str], None],
        intake: Intake | None = None,
    ) -> None:
        """``watch``: shows a scene in words; ``drive``: has the student drive it and keep the recording, with the
        lines of the same ``intake``."""
        self._visit = session
        self._watch = watch
        self._drive = drive
        self._lines = Lines(_nobody_looks_in, intake)
        self._file: FileWatcher | None = None
        self.step = session.first_step
        self.is_over = False

    def run(self) -> None:
        """Reads lines from standard input until ``q`` or its end."""
        lesson = self._visit.lesson
        done = self._visit.lesson_progress.completed_count
        click.echo(f"{lesson.title}. {lesson.summary} About {lesson.minutes} minutes.")
        if done:
            click.echo(f"{done} of {len(lesson.steps)} steps are done; going on at step {self.step.number}.")
        self.show()
        try:
            while not self.is_over:
                line = self._line()
                if line is None:
                    break
                self.obey(line)
        finally:
            self._lines.close()

    def obey(self, line: str) -> None:
        """Does what one line says. Mistakes are told, and change nothing."""
        word, _, rest = line.strip().partition(" ")
        if not word:
            return
        try:
            if word.isdecimal() and self._predicts:
                self.foresee(int(word))
                return
            verb = VERBS.get(word.lower())
            if verb is None or not verb.fits(self):
                raise Mistake(f"{word!r} does nothing here; ? says what does")
            verb.do(self, rest)
        except Mistake as mistake:
            click.echo(str(mistake))

    def show(self) -> None:
        """The step, from its title on."""
        step, count = self.step, len(self._visit.lesson.steps)
        mark = " (done)" if self._visit.lesson_progress.is_step_completed(step) else ""
        click.echo(f"\nStep {step.number} of {count}, {step.kind}: {step.title}{mark}")
        click.echo(f"Goal: {step.goal}\n")
        if step.picture:
            click.echo(f"{step.picture}\n")
        click.echo(self._filled(step.text))
        self._commands([each for each in step.commands if each.line not in step.text])
        if step.options:
            self._ask(step)
        if step.exercise is not None:
            self._open(step.exercise)
        click.echo(self._keys())

    def foresee(self, number: int) -> None:
        """What the student expects, kept; then what is so."""
        step = self.step
        if not 1 <= number <= len(step.options):
            raise Mistake(f"choose 1 to {len(step.options)}")
        kept = self._visit.prediction(step)
        option = self._visit.predict(step, number - 1)
        if kept is not None and kept is not option:
            click.echo(f"You foresaw first: {kept.text} That stays noted.")
        if step.scene is not None and kept is None:
            self._watch(step.scene)
        right = next(each for each in step.options if each.is_right)
        click.echo(_wrapped(f"{'Right.' if option.is_right else 'Not so.'} {option.feedback}"))
        if not option.is_right:
            click.echo(_wrapped(f"It is: {right.text.rstrip('.')}. {right.feedback}"))
        click.echo(self._keys())

    def go(self, number: int) -> None:
        if not 1 <= number <= len(self._visit.lesson.steps):
            raise Mistake(f"there are steps 1 to {len(self._visit.lesson.steps)}")
        self.step = self._visit.find_step(number)
        self.show()

    def on(self) -> None:
        """The next step; what was done of this one is noted."""
        step = self.step
        if self._predicts and self._visit.prediction(step) is None:
            raise Mistake(f"first say what you expect: 1 to {len(step.options)}")
        if step.exercise is None:
            self._visit.complete_step(step)
        elif not self._visit.lesson_progress.is_step_completed(step):
            click.echo("This exercise is not passed yet; you can come back to it.")
        if step.number == len(self._visit.lesson.steps):
            self._end()
            return
        self.go(step.number + 1)

    def check(self) -> None:
        """Has the exercise checked, and says what came of it."""
        exercise = self._exercise()
        click.echo("Checking...")
        try:
            with self._visit.start_check(exercise) as running:
                report = running.wait()
        except KeyboardInterrupt:
            click.echo("\nStopped; it does not count. r checks again, q leaves.")
            return
        self._visit.record(exercise, report)
        for line in report_lines(report):
            click.echo(line)
        if report.is_passed:
            click.echo("Passed. s shows the reference solution, n goes on.")
        elif report.lost_criteria and any(each.hints for each in report.lost_criteria):
            click.echo("h gives a hint.")

    def hint(self) -> None:
        exercise = self._exercise()
        hint = self._visit.next_hint(exercise)
        if hint is not None:
            more = f" ({hint.remaining} more)" if hint.remaining else ""
            click.echo(_wrapped(f"Hint {hint.number} for “{hint.criterion.title}”{more}: {hint.text}"))
            return
        opened = self._visit.opened_hints(exercise)
        if not opened:
            raise Mistake(
                "no hint was written for what is missing"
                if (report := self._visit.latest_report(exercise)) is not None and report.lost_criteria
                else "there is a hint when a check (r) has shown what is missing"
            )
        click.echo("These are all hints for it:")
        for each in opened:
            click.echo(_wrapped(f"- {each.text}"))

    def solution(self) -> None:
        files = self._visit.open_solution(self._exercise())
        if not files:
            raise Mistake("the solution was not installed" if self._is_passed else "first pass the exercise")
        for name, text in files.items():
            click.echo(f"--- {name}\n{text.rstrip()}")

    def printed(self) -> None:
        report = self._visit.latest_report(self._exercise())
        if report is None:
            raise Mistake("there is something to see when a check (r) has run it")
        logs = [each.log for each in report.criteria if each.log]
        click.echo(logs[0] if logs else "It printed nothing.")

    def begin_again(self, answer: str) -> None:
        exercise = self._exercise()
        if answer != "yes":
            raise Mistake("`x yes` lays the exercise out as at first; what you have is kept beside it")
        kept = self._visit.reset(exercise)
        click.echo("The exercise is as at first." + (f" What you had is in {kept}" if kept else ""))
        self._open(exercise)

    def watch(self) -> None:
        if self.step.scene is None:
            raise Mistake("there is nothing moving in this step")
        if self._predicts and self._visit.prediction(self.step) is None:
            raise Mistake(f"first say what you expect: 1 to {len(self.step.options)}")
        self._watch(self.step.scene)

    def drive(self) -> None:
        exercise, scene = self._exercise(), self.step.scene
        if not self._by_hand or scene is None:
            raise Mistake("this exercise is written, not driven")
        self._drive(scene, str(self._visit.exercise_file(exercise)))
        self.check()

    def help(self) -> None:
        for word, verb in VERBS.items():
            if verb.fits(self):
                click.echo(f"{word:<6} {verb.text}")
        click.echo("Progress is kept at once; leave whenever you like.")

    @property
    def _predicts(self) -> bool:
        return self.step.kind is StepKind.PREDICT

    @property
    def _is_passed(self) -> bool:
        return self._visit.lesson_progress.is_step_completed(self.step)

    @property
    def _by_hand(self) -> bool:
        return self.step.exercise is not None and self.step.exercise.is_driven

    def _exercise(self) -> Exercise:
        assert self.step.exercise is not None  # the verbs that ask do not fit elsewhere
        return self.step.exercise

    def _open(self, exercise: Exercise) -> None:
        file = self._visit.install(exercise)
        self._file = None if self._by_hand else FileWatcher(submission_path(exercise, file))
        click.echo(f"Your file: {file}")

    def _ask(self, step: LessonStep) -> None:
        click.echo(_wrapped(step.question))
        for number, option in enumerate(step.options, 1):
            click.echo(_wrapped(f"{number}. {option.text}", "   "))
        kept = self._visit.prediction(step)
        if kept is not None:
            click.echo(f"You foresaw: {kept.text}")

    def _commands(self, commands: Sequence[LessonCommand]) -> None:
        if commands:
            click.echo(
                "\nIn another terminal:" if len(commands) == 1 else "\nIn another terminal, one by one:"
            )
        for each in commands:
            click.echo(f"    {self._filled_line(each.line)}")
        click.echo()

    def _filled(self, text: str) -> str:
        return "\n".join(
            plain_text(row) for row in wrap_blocks(parse_markup(self._filled_line(text)), TEXT_WIDTH)
        )

    def _filled_line(self, text: str) -> str:
        """With the student's own paths."""
        if self.step.exercise is None:
            return text
        file = self._visit.exercise_file(self.step.exercise)
        return text.replace("{file}", str(file)).replace("{folder}", str(file.parent))

    def _keys(self) -> str:
        fitting = [word for word, verb in VERBS.items() if verb.fits(self)]
        choose = [f"1-{len(self.step.options)}"] if self._predicts else []
        return "\n" + "  ".join([*choose, *fitting])

    def _end(self) -> None:
        progress = self._visit.lesson_progress
        lesson = self._visit.lesson
        open_steps = [str(step.number) for step in lesson.steps if not progress.is_step_completed(step)]
        if open_steps:
            click.echo(f"That was the last step. Still open: {', '.join(open_steps)}. `g 3` goes to step 3.")
            return
        click.echo(
            f"{lesson.title} is done. `kit lesson` lists the others; `kit quiz {lesson.name}` asks what stayed."
        )
        self.is_over = True

    def _line(self) -> str | None:
        """The next line; None at the end of input. Meanwhile a saved file is checked."""
        self._prompt()
        while self._file is not None and not self._lines.await_line(LOOK_S):
            if self._file.has_changed():
                click.echo("\nSaved.")
                self.check()
                self._prompt()
        return self._lines.next()

    def _prompt(self) -> None:
        if sys.stdin is not None and sys.stdin.isatty():
            click.echo("> ", nl=False)


def report_lines(report: CheckReport) -> list[str]:
    """The outcome of a check, line by line."""
    if report.problem:
        return [_wrapped(report.problem)]
    lines = [plain_line(line) for each in report.criteria for line in criterion_lines(each, TEXT_WIDTH)]
    picture = replay_lines(report.criteria)
    if picture:
        lines += ["", *picture]
    lines.append(f"{points_text(report.points, report.max_points)} points, in {report.seconds:.1f} s")
    return lines


def _wrapped(text: str, indent: str = "") -> str:
    import textwrap

    return "\n".join(textwrap.wrap(text, TEXT_WIDTH, subsequent_indent=indent)) or text


def _nobody_looks_in() -> None:
    """There is no world to look into between two lines of a lesson."""


def _always(lesson: PlainLesson) -> bool:
    return True


def _writes(lesson: PlainLesson) -> bool:
    return lesson.step.exercise is not None


def _moves(lesson: PlainLesson) -> bool:
    return lesson.step.scene is not None


def _drives(lesson: PlainLesson) -> bool:
    return lesson._by_hand


def _leave(lesson: PlainLesson, rest: str) -> None:
    lesson.is_over = True


def _go(lesson: PlainLesson, rest: str) -> None:
    if not rest.strip().isdecimal():
        raise Mistake("say which step, such as: g 3")
    lesson.go(int(rest))


VERBS: Final[Mapping[str, Verb]] = {
    "n": Verb("on to the next step", lambda lesson, rest: lesson.on(), _always),
    "b": Verb("back one step", lambda lesson, rest: lesson.go(lesson.step.number - 1), _always),
    "g": Verb("go to a step: g 3", _go, _always),
    "t": Verb("the step's text again", lambda lesson, rest: lesson.show(), _always),
    "w": Verb("watch the robot", lambda lesson, rest: lesson.watch(), _moves),
    "d": Verb("drive yourself, and keep the drive", lambda lesson, rest: lesson.drive(), _drives),
    "r": Verb("check the exercise", lambda lesson, rest: lesson.check(), _writes),
    "h": Verb("a hint", lambda lesson, rest: lesson.hint(), _writes),
    "p": Verb("what your program printed", lambda lesson, rest: lesson.printed(), _writes),
    "s": Verb("the reference solution, after success", lambda lesson, rest: lesson.solution(), _writes),
    "x": Verb("begin the exercise again", lambda lesson, rest: lesson.begin_again(rest.strip()), _writes),
    "?": Verb("these lines", lambda lesson, rest: lesson.help(), _always),
    "q": Verb("leave", _leave, _always),
}

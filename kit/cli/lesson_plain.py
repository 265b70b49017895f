"""Runs a lesson line by line: for screen readers, pipes, and terminals without a full screen."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import click

from kit.cli.plain import CommandError, InputBuffer, InputLines
from kit.dialogue.actions import ACTIONS
from kit.document.layout import lines_of
from kit.document.markup import parse_markup, plain_text, wrap_blocks
from kit.geometry import whole_degrees
from kit.host.file_watcher import FileWatcher
from kit.render.encode import AsciiEncoder
from kit.run.recording import RecordingError
from kit.school.game.levels import opened_levels_text
from kit.school.lessons.checking import CheckReport, has_other_files, submission_path
from kit.school.lessons.defence import DefenceError
from kit.school.lessons.glossary import UnknownTerm, find_terms, glossary_blocks, read_glossary
from kit.school.lessons.graph_playback import graph_rows
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import TEXT_WIDTH
from kit.school.lessons.records import (
    CommandKind,
    Exercise,
    GraphScene,
    LearningScene,
    LessonCommand,
    LessonScene,
    LessonStep,
    StepKind,
)
from kit.school.lessons.shell_lines import fill_in_paths, second_terminal_here, shell_path
from kit.school.lessons.translation import missing_translation_text
from kit.school.result import criterion_lines, points_text, replay_lines
from kit.school.result import line_text as plain_line
from kit.world.problems import WorldError

FILE_POLL_S: Final = 0.2
"""Seconds between two tests whether the student's file was saved."""
PICTURE_ROWS: Final = 12


class LessonVerb(NamedTuple):
    word: str
    summary: str
    execute: Callable[[PlainLesson, str], None]
    is_available: Callable[[PlainLesson], bool]
    """Whether it can be used in this step."""


class PlainLesson:
    """One lesson, driven by lines of text."""

    def __init__(
        self,
        session: LessonSession,
        *,
        watch: Callable[[LessonScene | LearningScene | GraphScene], None],
        drive: Callable[[LessonScene, str], None],
        replay: Callable[[Path], None],
        input_buffer: InputBuffer | None = None,
    ) -> None:
        """``watch``: shows a scene in words; ``replay``: a recorded run; ``drive``: lets the student drive it and saves the recording, reading lines
        from the same ``input_buffer``."""
        self._session = session
        self._watch = watch
        self._drive = drive
        self._replay = replay
        self._lines = InputLines(_no_op, input_buffer)
        self._file: FileWatcher | None = None
        self.step = session.first_step
        self.is_over = False

    def run(self) -> None:
        """Reads lines from standard input until ``q`` or its end."""
        lesson = self._session.lesson
        done = self._session.lesson_progress.completed_count
        click.echo(
            f"Lesson {lesson.number}, {lesson.title}. {lesson.summary} About {lesson.minutes} minutes."
        )
        if text := missing_translation_text(lesson.missing_language):
            click.echo(text)
        if done:
            click.echo(f"{done} of {len(lesson.steps)} steps are done; going on at step {self.step.number}.")
        self.show()
        try:
            while not self.is_over:
                line = self._line()
                if line is None:
                    break
                self.execute_line(line)
        finally:
            self._lines.close()

    def execute_line(self, line: str) -> None:
        """Executes one line. Errors are printed, and change nothing."""
        if not line.strip():
            return
        try:
            word, rest = _split_line(line.strip())
            if word.isdecimal() and self._is_prediction:
                self.predict(int(word))
                return
            verb = VERBS.get(word)
            if verb is None or not verb.is_available(self):
                raise CommandError(f"{word!r} does nothing here; ? lists what does")
            verb.execute(self, rest)
        except CommandError as error:
            click.echo(str(error))

    def show(self) -> None:
        """The step, from its title on."""
        step, count = self.step, len(self._session.lesson.steps)
        mark = " (done)" if self._session.lesson_progress.is_step_completed(step) else ""
        click.echo(f"\nStep {step.number} of {count}, {step.kind}: {step.title}{mark}")
        click.echo(f"Goal: {step.goal}\n")
        if step.picture:
            click.echo(f"{step.picture}\n")
        if step.graph is not None:
            click.echo("\n".join([*graph_rows(step.graph, at_end=not step.options), ""]))
        click.echo(self._format_text(step.text))
        self._print_commands([each for each in step.commands if each.line not in step.text])
        if step.options:
            self._print_question(step)
        self._file = None
        if step.exercise is not None:
            self._install(step.exercise)
        click.echo(self._available_keys())

    def predict(self, number: int) -> None:
        """Records the student's prediction, then prints the right answer."""
        step = self.step
        if not 1 <= number <= len(step.options):
            raise CommandError(f"choose 1 to {len(step.options)}")
        kept = self._session.prediction(step)
        option = self._session.predict(step, number - 1)
        if kept is not None and kept is not option:
            click.echo(f"Your first prediction counts: {kept.text}")
        if (scene := self._scene) is not None and kept is None:
            self._watch(scene)
        right = next(each for each in step.options if each.is_right)
        click.echo(_wrap(f"{'Right.' if option.is_right else 'Not this time.'} {option.feedback}"))
        if not option.is_right:
            click.echo(_wrap(f"The answer: {right.text.rstrip('.')}. {right.feedback}"))
        click.echo(self._available_keys())

    def go(self, number: int) -> None:
        if not 1 <= number <= len(self._session.lesson.steps):
            raise CommandError(f"give a step from 1 to {len(self._session.lesson.steps)}")
        self.step = self._session.find_step(number)
        self.show()

    def go_on(self) -> None:
        """Goes to the next step and records this one as done, unless it is an exercise."""
        step = self.step
        if self._is_prediction and self._session.prediction(step) is None:
            raise CommandError(f"predict first: type 1 to {len(step.options)}")
        if step.exercise is None:
            self._session.complete_step(step)
        elif not self._session.lesson_progress.is_step_completed(step):
            click.echo("This exercise is not passed yet; you can come back to it.")
        if step.number == len(self._session.lesson.steps):
            self._print_end()
            return
        self.go(step.number + 1)

    def check(self) -> None:
        """Checks the exercise and prints the result."""
        exercise = self._exercise()
        if not self._session.has_driven(exercise):
            raise CommandError("you have not driven yet: d opens the drive")
        click.echo("Checking ...")
        self._watch_file(exercise)  # what is checked now need not be checked once more
        try:
            with self._session.start_check(exercise) as running:
                # A pipe or a file gets the result alone.
                is_read = sys.stdout.isatty()
                report = running.wait((lambda text: click.echo(f"  {text}")) if is_read else None)
                curves = running.training_curves
        except KeyboardInterrupt:
            click.echo("\nStopped; this check does not count. c checks again, q quits.")
            return
        self._session.record(exercise, report)
        if curves is not None:
            for line in (*curves.picture(TEXT_WIDTH, AsciiEncoder()), *curves.describe()):
                click.echo(line)
        for line in report_lines(report):
            click.echo(line)
        if report.is_passed:
            click.echo(f"Passed: ***. {'w your run, ' if report.recording else ''}n next, s solution.")
        elif report.lost_criteria and any(each.hints for each in report.lost_criteria):
            click.echo("h for a hint.")

    def list_steps(self) -> None:
        for each in self._session.lesson.steps:
            mark = "[x]" if self._session.lesson_progress.is_step_completed(each) else "[ ]"
            click.echo(f"{mark} {each.number} {each.title}")
        click.echo("Type l and a number to go to that step.")

    def hint(self) -> None:
        exercise = self._exercise()
        hint = self._session.next_hint(exercise)
        if hint is not None:
            more = f" ({hint.remaining} more)" if hint.remaining else ""
            click.echo(_wrap(f"Hint {hint.number} for “{hint.criterion.title}”{more}: {hint.text}"))
            return
        opened = self._session.opened_hints(exercise)
        if not opened:
            raise CommandError(
                "there is no hint for what is missing"
                if (report := self._session.latest_report(exercise)) is not None and report.lost_criteria
                else "check first (c): hints are for criteria that you missed"
            )
        click.echo("You have seen all its hints:")
        for each in opened:
            click.echo(_wrap(f"- {each.text}"))

    def solution(self) -> None:
        files = self._session.open_solution(self._exercise())
        if not files:
            raise CommandError(
                "the solution was not installed" if self._is_passed else "pass the exercise first"
            )
        for name, text in files.items():
            click.echo(f"--- {name}\n{text.rstrip()}")

    def show_output(self) -> None:
        report = self._session.latest_report(self._exercise())
        if report is None:
            raise CommandError("your program has not run yet: c checks it")
        logs = [each.log for each in report.criteria if each.log]
        click.echo(logs[0] if logs else "Your program printed nothing.")

    def explain_second_terminal(self) -> None:
        text = second_terminal_here(self._session.workspace)
        click.echo("\n".join(plain_text(each) for each in wrap_blocks(parse_markup(text), TEXT_WIDTH)))

    def replay(self) -> None:
        """Says how the run of the newest check went, or of the work that passed before."""
        file = self._session.recorded_run(self._exercise())
        if file is None:
            raise CommandError("no run was recorded yet: c checks the exercise")
        try:
            self._replay(file)
        except (OSError, LookupError, RecordingError, WorldError) as error:
            raise CommandError(f"the run cannot be shown: {error}") from None

    def defend(self) -> None:
        """Asks what the student's program will do from a new start, and then says what it does."""
        exercise = self._exercise()
        if not self._session.can_defend(exercise):
            raise CommandError(
                "there are no questions yet: first pass the exercise with a program that drives"
            )
        click.echo("Running your program once, off screen, from a new start ...")
        try:
            defence = self._session.prepare_defence(exercise)
        except DefenceError as error:
            raise CommandError(str(error)) from None
        x, y, theta = defence.start
        click.echo(f"It starts at x {x:.2f}, y {y:.2f}, heading {whole_degrees(theta)} degrees.")
        answers: list[int] = []
        for number, question in enumerate(defence.questions, 1):
            click.echo(_wrap(f"{number} of {len(defence.questions)}. {question.text}"))
            for at, option in enumerate(question.options, 1):
                click.echo(f"   {at}. {option}")
            reply = self._lines.read_line()
            while reply is not None and not (
                reply.strip().isdecimal() and 1 <= int(reply) <= len(question.options)
            ):
                click.echo(f"1 to {len(question.options)}.")
                reply = self._lines.read_line()
            if reply is None:
                return
            answers.append(int(reply) - 1)
        right = self._session.record_defence(exercise, defence, answers)
        for question, answer in zip(defence.questions, answers, strict=True):
            mark = "Right." if answer == question.right else f"No: {question.options[question.right]}"
            click.echo(_wrap(f"{question.text} {mark}"))
        click.echo(
            "All correct: one more star." if right == len(answers) else f"{right} of {len(answers)} right."
        )

    def reset_exercise(self, answer: str) -> None:
        exercise = self._exercise()
        if answer != "yes":
            raise CommandError("type `x yes` to start the exercise over; your files are kept beside it")
        kept = self._session.reset(exercise)
        click.echo("Started over." + (f" Your files are kept in {kept}" if kept else ""))
        self._install(exercise)

    def watch(self) -> None:
        if (scene := self._scene) is None:
            raise CommandError("there is no scene to restart here")
        if self._is_prediction and self._session.prediction(self.step) is None:
            raise CommandError(f"predict first: type 1 to {len(self.step.options)}")
        self._watch(scene)

    def drive(self) -> None:
        exercise, scene = self._exercise(), self.step.scene
        if not self._is_driven or scene is None:
            raise CommandError("this exercise needs a program, not a drive")
        self._drive(scene, str(self._session.exercise_file(exercise)))
        self.check()

    def help(self) -> None:
        for word, verb in VERBS.items():
            if verb.is_available(self):
                click.echo(f"{word:<3} {verb.word:<11} {verb.summary}")
        click.echo("Type a letter or its word. Progress is saved at once; quit whenever you like.")

    @property
    def _scene(self) -> LessonScene | LearningScene | GraphScene | None:
        """The scene or playback of this step, if it has one."""
        return self.step.scene or self.step.playback_scene

    @property
    def _is_prediction(self) -> bool:
        return self.step.kind is StepKind.PREDICT

    @property
    def _is_passed(self) -> bool:
        return self._session.lesson_progress.is_step_completed(self.step)

    @property
    def _is_driven(self) -> bool:
        return self.step.exercise is not None and self.step.exercise.is_driven

    def _exercise(self) -> Exercise:
        assert self.step.exercise is not None  # the verbs that ask do not fit elsewhere
        return self.step.exercise

    def _install(self, exercise: Exercise) -> None:
        file = self._session.install(exercise)
        self._watch_file(exercise)
        edited = file.parent / exercise.edited_first if exercise.edited_first else file
        others = ", and the files beside it" if has_other_files(exercise) else ""
        click.echo(f"Your file: {shell_path(edited)}{others}")

    def _watch_file(self, exercise: Exercise) -> None:
        """Watches the exercise's file from now on: it is checked each time it is saved."""
        file = self._session.exercise_file(exercise)
        self._file = None if self._is_driven else FileWatcher(submission_path(exercise, file))

    def _print_question(self, step: LessonStep) -> None:
        click.echo(_wrap(step.question))
        for number, option in enumerate(step.options, 1):
            click.echo(_wrap(f"{number}. {option.text}", "   "))
        kept = self._session.prediction(step)
        if kept is not None:
            click.echo(f"You predicted: {kept.text}")

    def _print_commands(self, commands: Sequence[LessonCommand]) -> None:
        if commands:
            beside = any(each.kind is CommandKind.BESIDE for each in commands)
            one_by_one = ", one by one" if len(commands) > 1 else ""
            how = " (type a to see how to open one)" if beside else ""
            click.echo(f"\nIn a second terminal{one_by_one}{how}:")
        for each in commands:
            click.echo(f"    {self._insert_paths(each.line)}")
        click.echo()

    def _format_text(self, text: str) -> str:
        return "\n".join(
            plain_text(row) for row in wrap_blocks(parse_markup(self._insert_paths(text)), TEXT_WIDTH)
        )

    def _insert_paths(self, text: str) -> str:
        """Replaces ``{file}`` and ``{folder}`` by the student's own paths."""
        exercise = self.step.exercise
        return fill_in_paths(text, None if exercise is None else self._session.exercise_file(exercise))

    def _available_keys(self) -> str:
        fitting = [f"{letter} {verb.word}" for letter, verb in VERBS.items() if verb.is_available(self)]
        choose = [f"1-{len(self.step.options)} predict"] if self._is_prediction else []
        return "\n" + _wrap("  ".join([*choose, *fitting]))

    def _print_end(self) -> None:
        progress = self._session.lesson_progress
        lesson = self._session.lesson
        open_steps = [str(step.number) for step in lesson.steps if not progress.is_step_completed(step)]
        if open_steps:
            click.echo(
                f"That was the last step. Not done yet: {', '.join(open_steps)}. `l 3` goes to step 3."
            )
            return
        click.echo(
            f"{lesson.title} is done. `kit lesson` lists the others; `kit quiz {lesson.number}` tests what you remember."
        )
        if text := opened_levels_text(self._session.opened_levels()):
            click.echo(text)
        if (following := self._session.following()) is not None:
            number, title = following.lesson.number, following.lesson.title
            click.echo(f"The next lesson is {number} {title}: kit lesson {number}")
        self.is_over = True

    def _line(self) -> str | None:
        """The next line; None at the end of input. Meanwhile a saved file is checked."""
        self._prompt()
        while self._file is not None and not self._lines.wait_for_line(FILE_POLL_S):
            if self._file.has_changed():
                click.echo("\nSaved.")
                self.check()
                self._prompt()
        return self._lines.read_line()

    def _prompt(self) -> None:
        if sys.stdin is not None and sys.stdin.isatty():
            click.echo("> ", nl=False)


def report_lines(report: CheckReport) -> list[str]:
    """The outcome of a check, line by line."""
    if report.problem:
        return [_wrap(report.problem)]
    lines = [plain_line(line) for each in report.criteria for line in criterion_lines(each, TEXT_WIDTH)]
    picture = replay_lines(report.criteria)
    if picture:
        lines += ["", *picture]
    level = "" if report.result is None else f" at confinement level {report.result.level}"
    lines.append(f"{points_text(report.points, report.max_points)} points, in {report.seconds:.1f} s{level}")
    return lines


def _wrap(text: str, indent: str = "") -> str:
    return "\n".join(textwrap.wrap(text, TEXT_WIDTH, subsequent_indent=indent)) or text


def _no_op() -> None:
    """No-op: a lesson serves no other terminals."""


def _always(lesson: PlainLesson) -> bool:
    return True


def _has_exercise(lesson: PlainLesson) -> bool:
    return lesson.step.exercise is not None


def _has_commands(lesson: PlainLesson) -> bool:
    return bool(lesson.step.commands)


def _has_scene(lesson: PlainLesson) -> bool:
    return lesson.step.moves


def _is_driven_exercise(lesson: PlainLesson) -> bool:
    return lesson._is_driven


def _is_program_exercise(lesson: PlainLesson) -> bool:
    return lesson.step.exercise is not None and lesson.step.exercise.is_program


def _leave(lesson: PlainLesson, rest: str) -> None:
    lesson.is_over = True


def _go(lesson: PlainLesson, rest: str) -> None:
    if rest.strip().isdecimal():
        lesson.go(int(rest))
    else:
        lesson.list_steps()


def _glossary(term: str) -> None:
    terms = read_glossary()
    try:
        shown = find_terms(terms, term) if term else terms
    except UnknownTerm as error:
        raise CommandError(str(error)) from None
    click.echo("\n".join(lines_of(glossary_blocks(shown))))


def _split_line(line: str) -> tuple[str, str]:
    """The letter of the verb, and the rest, of a line that begins with a letter or with a verb's word."""
    lowered = line.lower()
    for letter, verb in VERBS.items():
        if lowered == verb.word or lowered.startswith(f"{verb.word} "):
            return letter, line[len(verb.word) :].strip()
    word, _, rest = line.partition(" ")
    return word.lower(), rest


def _verb(
    action: str,
    execute: Callable[[PlainLesson, str], None],
    is_available: Callable[[PlainLesson], bool],
    summary: str = "",
) -> tuple[str, LessonVerb]:
    """Letter and verb of an action of the screens. ``summary``: where it differs from theirs."""
    found = ACTIONS[action]
    return found.keys.split()[0], LessonVerb(found.label, summary or found.help, execute, is_available)


VERBS: Final[Mapping[str, LessonVerb]] = dict(
    (
        _verb("next", lambda lesson, rest: lesson.go_on(), _always, "go to the next step"),
        _verb("previous", lambda lesson, rest: lesson.go(lesson.step.number - 1), _always, "go to the previous step"),
        _verb("steps", _go, _always, "list all steps; l 3 goes to step 3"),
        ("t", LessonVerb("text", "show the text of this step again", lambda lesson, rest: lesson.show(), _always)),
        _verb("restart", lambda lesson, rest: lesson.watch(), _has_scene, "watch the scene from its beginning"),
        _verb("drive", lambda lesson, rest: lesson.drive(), _is_driven_exercise, "drive; your drive is saved and checked"),
        _verb("check", lambda lesson, rest: lesson.check(), _has_exercise),
        _verb("hint", lambda lesson, rest: lesson.hint(), _has_exercise),
        _verb("second_terminal", lambda lesson, rest: lesson.explain_second_terminal(), _has_commands),
        _verb("output", lambda lesson, rest: lesson.show_output(), _has_exercise),
        _verb("replay", lambda lesson, rest: lesson.replay(), _has_exercise, "describe your last run in words"),
        _verb("solution", lambda lesson, rest: lesson.solution(), _has_exercise),
        _verb("defend", lambda lesson, rest: lesson.defend(), _is_program_exercise),
        _verb("start_over", lambda lesson, rest: lesson.reset_exercise(rest.strip()), _has_exercise, "x yes: start over with the starter files"),
        _verb("glossary", lambda lesson, rest: _glossary(rest), _always, "explain the terms; , node explains node"),
        ("?", LessonVerb("help", "show this list", lambda lesson, rest: lesson.help(), _always)),
        ("q", LessonVerb("quit", "quit the lesson", _leave, _always)),
    )
)  # fmt: skip

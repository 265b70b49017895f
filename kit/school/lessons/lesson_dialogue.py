"""A lesson as a dialogue: one step at a time; predict, run, change a file, have it checked. Nothing moves on by itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

from kit.dialogue.dialogue import Dialogue, DialogueAction, Refused, help_action, leave_action
from kit.dialogue.effects import Choose, Effect, Leave, Open, Option, Remark, Show, Tell, Work
from kit.dialogue.screen_action import ScreenAction, digits, letter
from kit.dialogue.shared_actions import ACTIONS
from kit.document.blocks import Block, Marked, Picture, Text, Tone
from kit.render.encode import AsciiEncoder
from kit.run.scenario import find_scenario
from kit.school.lessons.checking import CheckReport, ExerciseFilesError
from kit.school.lessons.defence import Defence, DefenceError
from kit.school.lessons.defence_dialogue import DefenceDialogue
from kit.school.lessons.exercise_work import ExerciseAttempt
from kit.school.lessons.glossary import glossary_action
from kit.school.lessons.graph_playback import graph_rows
from kit.school.lessons.lesson_session import LessonHint, LessonSession
from kit.school.lessons.lesson_text import (
    command_blocks,
    ending_blocks,
    feedback_blocks,
    question_blocks,
    status_text,
    verdict_blocks,
)
from kit.school.lessons.own_agent import OwnAgentError, OwnAgentFilm, describe_film, make_film
from kit.school.lessons.reading import TEXT_WIDTH
from kit.school.lessons.records import (
    CommandKind,
    Exercise,
    LessonCommand,
    LessonScene,
    LessonStep,
    PredictionOption,
)
from kit.school.lessons.shell_lines import TITLE as SECOND_TERMINAL
from kit.school.lessons.shell_lines import fill_in_paths, second_terminal_here, shell_path
from kit.school.lessons.stage import NoStage, Stage
from kit.school.lessons.translation import missing_translation_text
from kit.school.progress import ProgressError
from kit.school.quiz.items import read_bank
from kit.school.quiz.quiz_dialogue import QuizDialogue
from kit.school.quiz.quiz_session import QuizSession, lesson_plan, student_seed
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Scenario


@dataclass(frozen=True, slots=True)
class Edit:
    """A file to be opened in the student's editor. Comes to a sentence: why no editor opened; empty: one did."""

    file: Path
    line: int


@dataclass(frozen=True, slots=True)
class EditHere:
    """A file to be opened in an editor beside the lesson, where the face has one. Comes to a sentence, as ``Edit``."""

    file: Path
    line: int


@dataclass(frozen=True, slots=True)
class Drive:
    """A scene to be driven by hand, and the file to keep the drive in. Comes to None where nothing was driven, else to a
    sentence: why it could not be kept; empty: it was."""

    scene: LessonScene
    file: Path


@dataclass(frozen=True, slots=True)
class Replay:
    """A recorded run to be looked at. Comes to a sentence: why it cannot be shown; empty: it was."""

    file: Path


@dataclass(frozen=True, slots=True)
class RunCommand:
    """A command to be run in this terminal. Comes to what it printed, if that is to be read page by page; None: it cannot be
    run here."""

    line: str
    folder: Path | None
    waits: bool
    """Whether what it printed is to be read before one goes back."""


class LessonDialogue(Dialogue):
    """Takes a student through one lesson, and on to the next."""

    name = "lesson"
    help_title = "This lesson"
    failures = MappingProxyType(
        {
            ProgressError: "This could not be saved: {}",
            ExerciseFilesError: "The exercise files cannot be created: {}",
            DefenceError: "{}",
            OwnAgentError: "{}",
            WorldError: "{}",
            FileNotFoundError: "{}",
        }
    )

    def __init__(self, session: LessonSession) -> None:
        self.session = session
        self.step: LessonStep = session.first_step
        self.stage: Stage = NoStage()
        self.work: ExerciseAttempt | None = None
        """The work on the step's exercise; None where it has none."""
        self._works: dict[str, ExerciseAttempt] = {}
        """The work on each exercise of this lesson that was come to. A check goes on while another step is looked at."""
        self.has_ended = False
        """Whether the last step is behind one."""
        self.is_answer_shown = True
        """Whether the answer to a prediction may be shown: the scene has been watched to its end."""
        self._problem = ""
        """Why the exercise's files could not be laid out."""
        self._opening_step = self.step
        """Where it is said that the lesson is in another language than the one asked for."""
        self._next_lesson: LessonSession | None = None
        """The next lesson, once this one has ended."""
        self._allowed_lines: set[str] = set()
        """Commands of somebody else's lesson that the student has seen and let run."""
        self._looks_at = ""
        """What was just said: ``answer``, ``verdict``, ``hint`` or ``film``."""
        self._newest_hint: LessonHint | None = None
        """The one that was opened last."""
        self.is_writing = False
        """Whether keys are letters of the program, in an editor beside the lesson. The face says so."""
        self.is_at_code = False
        """Whether the program is read and scrolled, not the words of the step."""
        self.is_code_cut = False
        """Whether not all of the program is in sight beside the words. The face says so."""
        self._film: OwnAgentFilm | None = None
        """The film of the student's own agent, in the step that shows it."""
        self._drive_follows = False
        """Whether the drive comes once the floor has been learned before one's eyes."""

    def begin(self, stage: Stage) -> None:
        """Opens the first step, its scene on this stage."""
        self.stage = stage
        self.enter(self.step)

    def enter(self, step: LessonStep) -> None:
        """Comes to a step."""
        self.step, self.work, self.has_ended, self._problem, self._looks_at = step, None, False, "", ""
        self._film, self._drive_follows, self.is_at_code = None, False, False
        self.is_answer_shown = not self.is_waiting
        if step.exercise is not None:
            try:
                self.work = self._work_on(step.exercise)
            except ExerciseFilesError as error:
                self._problem = f"The exercise files cannot be created: {error}"
        self.stage.open(step, still=self.begins_still)

    def _work_on(self, exercise: Exercise) -> ExerciseAttempt:
        if exercise.name not in self._works:
            self._works[exercise.name] = ExerciseAttempt(self.session, exercise)
        return self._works[exercise.name]

    def _close_works(self) -> None:
        """Ends every check of this lesson."""
        for each in self._works.values():
            each.close()
        self._works.clear()

    # Where one is

    @property
    def chosen(self) -> PredictionOption | None:
        """The prediction that was made in this step."""
        return self.session.prediction(self.step)

    @property
    def is_waiting(self) -> bool:
        """Whether the step waits for a prediction."""
        return bool(self.step.options) and self.chosen is None

    @property
    def has_scene(self) -> bool:
        """Whether something moves in this step: its own scene, or the student's run."""
        return not self.has_ended and (self.step.moves or self.stage.is_recorded or self._film is not None)

    @property
    def begins_still(self) -> bool:
        """Whether the step's scene stands at its first instant: until a prediction, or until it is opened to be driven."""
        return self.is_waiting or (self.work is not None and self.work.by_hand)

    @property
    def is_still(self) -> bool:
        """The same of what is shown now."""
        return self.begins_still and not self.stage.is_recorded

    @property
    def is_driving(self) -> bool:
        """Whether the arrow keys drive in the scene."""
        scene = self.step.scene
        is_by_hand = scene is not None and scene.controller == "teleop" and not self.stage.is_recorded
        return is_by_hand and self.has_scene and not self.is_still

    @property
    def is_playing_back(self) -> bool:
        """Whether tables learn or messages move in the picture, or would if they were not held."""
        is_learning = self._film is not None and not self.stage.is_recorded
        return (
            (self.step.playback_scene is not None or is_learning) and not self.is_still and not self.has_ended
        )

    @property
    def report(self) -> CheckReport | None:
        """The newest check of the step's exercise."""
        return None if self.work is None else self.work.report

    def with_paths(self, text: str) -> str:
        """Inserts the student's own paths."""
        return fill_in_paths(text, None if self.work is None else self.work.file)

    # What is shown

    @property
    def title(self) -> str:
        return f"{self.session.lesson.number} {self.session.lesson.title}"

    @property
    def position(self) -> str:
        if self.has_ended:
            return ""
        done = " (done)" if self.session.lesson_progress.is_step_completed(self.step) else ""
        count = len(self.session.lesson.steps)
        return f"step {self.step.number} of {count}, {self.step.kind}: {self.step.title}{done}"

    @property
    def place(self) -> object:
        return self.session.lesson.name, 0 if self.has_ended else self.step.number

    @property
    def block_in_view(self) -> Block | None:
        said = self.reply_blocks()
        match self._looks_at:
            case "hint" if (newest := self._newest_hint) is not None:
                lead = f"Hint {newest.number} of "
                hints = (each for each in said if isinstance(each, Text) and each.lead.startswith(lead))
                return next((each for each in hints if each.text == newest.text), None)
            case "verdict":
                lost = (
                    each
                    for each in said
                    if isinstance(each, Text) and each.lead and each.lead_tone is Tone.BAD
                )
                return next(lost, said[0] if said else None)
            case "answer" | "film":
                return said[0] if said else None
        return None

    @property
    def note(self) -> Text | None:
        if self._problem:
            return Text(self._problem, Tone.BAD)
        if self.work is None or self.has_ended:
            told = (
                f"Step {each.number} is being checked: {self._progress_of(each)}"
                for each in self.checked_elsewhere
            )
            return next((Text(each, Tone.DIM) for each in told), None)
        session, exercise = self.session, self.work.exercise
        return status_text(
            self.report,
            session.lesson_progress,
            exercise,
            has_hint=session.has_closed_hints(exercise),
            is_writing=self.is_writing,
        )

    def opening(self) -> Sequence[Block]:
        lesson, progress = self.session.lesson, self.session.lesson_progress
        blocks = [
            Text(f"Lesson {lesson.number}, {lesson.title}. {lesson.summary} About {lesson.minutes} minutes.")
        ]
        if progress.completed_count:
            done = f"{progress.completed_count} of {len(lesson.steps)} steps are done"
            blocks.append(Text(f"{done}; going on at step {self.step.number}.", is_tight=True))
        return blocks

    def farewell(self) -> Sequence[Block]:
        return (Text("Your progress is saved."),)

    def arrival_blocks(self) -> Sequence[Block]:
        if self.has_ended:
            return ()
        blocks: list[Block] = [Text(f"Goal: {self.step.goal}", is_tight=True)]
        blocks += Picture.of_diagram(self.step.picture.splitlines())
        if self.step.graph is not None:
            blocks.append(Picture(tuple(graph_rows(self.step.graph, at_end=not self.step.options)), indent=0))
        return blocks

    def blocks(self) -> Sequence[Block]:
        return [*self.step_blocks(), *self.prediction_blocks(), *self.reply_blocks()]

    def step_blocks(self) -> list[Block]:
        """The words of the step and its commands; after the last step those of the end."""
        if self.has_ended:
            next_lesson = self._next_lesson.lesson if self._next_lesson is not None else None
            return ending_blocks(self.session.lesson_progress, next_lesson, self.session.opened_levels())
        missing = self.session.lesson.missing_language if self.step is self._opening_step else ""
        blocks: list[Block] = [Text(missing_translation_text(missing))] if missing else []
        text = self.with_paths(self.step.text)
        filled = [
            (each, line) for each in self.step.commands if (line := self.with_paths(each.line)) not in text
        ]
        blocks += [Marked(text), *command_blocks(filled)]
        if self.work is not None and self.stage.is_described:
            others = ", and the files beside it" if self.work.has_others else ""
            # On one line, however long, so that it can be copied.
            blocks.append(Picture((f"Your file: {shell_path(self.work.edited_file)}{others}",), indent=0))
        return blocks

    def prediction_blocks(self) -> list[Block]:
        """The question of a prediction."""
        if self.has_ended or not self.step.options:
            return []
        return question_blocks(self.step, self.chosen, is_told=self.is_answer_shown)

    def reply_blocks(self) -> list[Block]:
        """What is said to what the student did."""
        if self.has_ended:
            return []
        blocks: list[Block] = []
        if self.chosen is not None and self.is_answer_shown:
            blocks += feedback_blocks(self.step, self.chosen)
        if (film := self._film) is not None:
            again = " This shows the drive again, also tomorrow:" if film.moves else ""
            blocks.append(Text(f"{describe_film(film)}{again}", Tone.GOOD if film.is_solved else Tone.WARN))
            if film.moves:
                blocks.append(Picture((f"kit replay {shell_path(film.file)}",)))
        work, report = self.work, self.report
        if work is not None and report is not None and work.seconds is None:
            if self.stage.is_described and (curves := work.training_curves) is not None:
                blocks.append(Picture(tuple(curves.picture(TEXT_WIDTH, AsciiEncoder())), indent=0))
                blocks += [Text(line, is_tight=True) for line in curves.describe()]
            verdict = verdict_blocks(report, self.session.opened_hints(work.exercise))
            blocks += verdict
            if self.stage.is_described and work.picture_lines:
                blocks.append(Picture(tuple(work.picture_lines), indent=0))
        return blocks

    def possible_answers(self) -> list[list[Block]]:
        """What may be said to each prediction."""
        return [feedback_blocks(self.step, option) for option in self.step.options]

    # Something that goes on

    @property
    def busy(self) -> str:
        if self.work is None or self.work.seconds is None:
            return ""
        return self.work.progress or "Checking ..."

    @property
    def polls(self) -> bool:
        """Whether time brings something: a check that runs, or a file that may be saved anew. A drive by hand is not."""
        is_edited = self.work is not None and not self.work.by_hand
        return bool(self.busy or self.checked_elsewhere) or is_edited

    def _progress_of(self, step: LessonStep) -> str:
        assert step.exercise is not None
        return self._works[step.exercise.name].progress or "it has begun"

    @property
    def checked_elsewhere(self) -> list[LessonStep]:
        """The other steps whose exercise is being checked."""
        return [
            step
            for step in self.session.lesson.steps
            if step.exercise is not None
            and (work := self._works.get(step.exercise.name)) is not None
            and work is not self.work
            and work.seconds is not None
        ]

    def poll(self) -> Effect:
        said = [text for step in self.checked_elsewhere if (text := self._poll_other_check(step))]
        effect = self._poll_present_check()
        return Remark(" ".join(said), Tone.DIM) if effect is None and said else effect

    def _poll_other_check(self, step: LessonStep) -> str:
        """Takes in the check of another step; what it found, once it has ended."""
        assert step.exercise is not None
        work = self._works[step.exercise.name]
        if not work.poll() or work.report is None:
            return ""
        found = "passed" if work.report.is_passed else "not yet passed"
        return f"The check of step {step.number} has ended: {found}."

    def _poll_present_check(self) -> Effect:
        work = self.work
        if work is None:
            return None
        was_busy = work.seconds is not None
        try:
            ended = work.poll()
        finally:  # where the disk refuses to note it, the report is there all the same
            if was_busy and work.seconds is None:
                self._looks_at = "verdict"
                if self.stage.is_recorded and not (work.report is not None and work.report.is_passed):
                    self.stage.open(self.step, still=self.begins_still)
        report = work.report
        if not ended or report is None or report.recording is None or self.stage.is_described:
            return None
        if not report.is_passed and not self.stage.is_roomy:  # what is said of it needs the room
            return None
        file = report.recording
        return Work("", lambda _: _load_run(file), lambda run: self._play(work, run))

    def _play(self, work: ExerciseAttempt, run: tuple[Recording, Scenario] | None) -> Effect:
        if run is not None and self.work is work:
            self.stage.play(*run)
        return None

    def stop(self) -> Effect:
        if self.work is not None:
            self.work.close()
        return Remark("Stopped; this check does not count. c checks again, q quits.")

    def close(self) -> None:
        self._close_works()
        self.stage.close()

    def on_scene_end(self) -> bool:
        """The scene has come to its end: what there is to say of a prediction may be said. Returns whether it is now."""
        if self._film is not None and self._drive_follows:
            self._drive_follows = False
            if self._film.moves:
                self.stage.play(self._film.recording, self._film.place)
            return True
        if self.is_answer_shown or self.is_waiting:
            return False
        self._reveal()
        return True

    def _reveal(self) -> None:
        self.is_answer_shown = True
        self._looks_at = "answer"

    # What is done

    def predict(self, number: int) -> Effect:
        if number > len(self.step.options):
            raise Refused(f"Choose 1 to {len(self.step.options)}.")
        self.session.predict(self.step, number - 1)
        if self.step.moves and self.stage.is_open:
            self.stage.go()
            if self.stage.is_resting:
                self._reveal()
        else:
            if self.step.moves:
                self.stage.replay()
            self._reveal()
        return None

    def go_on(self) -> Effect:
        if self.has_ended:
            return self._begin_next_lesson()
        if not self.is_answer_shown:
            self._reveal()
            return None
        if self.step.exercise is None:
            self.session.complete_step(self.step)
        if self.step.number < len(self.session.lesson.steps):
            is_open = not (self.busy or self.session.lesson_progress.is_step_completed(self.step))
            self.enter(self.session.find_step(self.step.number + 1))
            return Remark("Not passed yet: b goes back to the exercise.", Tone.DIM) if is_open else None
        self.stage.close()
        self.work, self.has_ended, self._looks_at = None, True, ""
        self._next_lesson = self.session.find_next()
        return None

    def _begin_next_lesson(self) -> Effect:
        if self._next_lesson is not None:
            is_told = bool(self.session.lesson.missing_language)
            self._close_works()
            self.session, self._next_lesson = self._next_lesson, None
            self._opening_step = self._opening_step if is_told else self.session.first_step
            self.enter(self.session.first_step)
        return None

    def go_back(self) -> Effect:
        number = self.step.number if self.has_ended else self.step.number - 1
        self.enter(self.session.find_step(number))
        return None

    def go_to(self, number: str = "") -> Effect:
        steps, progress = self.session.lesson.steps, self.session.lesson_progress
        if number:
            if not number.isdecimal() or not 1 <= int(number) <= len(steps):
                raise Refused(f"Give a step from 1 to {len(steps)}.")
            return self._enter_chosen(int(number) - 1)
        options = [
            Option(f"{'[x]' if progress.is_step_completed(each) else '[ ]'} {each.number}", each.title)
            for each in steps
        ]
        return Choose(self.session.lesson.title, options, self._enter_chosen, self.step.number - 1)

    def _enter_chosen(self, index: int | None) -> Effect:
        if index is not None:
            self.enter(self.session.lesson.steps[index])
        return None

    def restart(self) -> Effect:
        self.stage.replay()
        return None

    def pause(self) -> Effect:
        self.stage.set_paused(not self.stage.is_paused)
        return None

    def step_once(self) -> Effect:
        self.stage.step_once()
        return None

    def run_command(self) -> Effect:
        commands = self.step.runnable_commands
        if len(commands) == 1:
            return self._show_command(commands[0])
        options = [Option(self.with_paths(each.line)) for each in commands]
        return Choose(
            "Run", options, lambda index: None if index is None else self._show_command(commands[index])
        )

    def _show_command(self, command: LessonCommand) -> Effect:
        """Runs a command; one of somebody else's lesson is shown before it runs for the first time."""
        line = self.with_paths(command.line)
        if not self.session.lesson.is_foreign or line in self._allowed_lines:
            return self._run(command)
        options = [Option("do not run it"), Option("run", line)]
        return Choose(
            "The author's command", options, lambda index: self._allow(command) if index == 1 else None
        )

    def _allow(self, command: LessonCommand) -> Effect:
        self._allowed_lines.add(self.with_paths(command.line))
        return self._run(command)

    def _run(self, command: LessonCommand) -> Effect:
        line = self.with_paths(command.line)
        folder = self.work.file.parent if self.work is not None else None

        def ended(printed: str | None) -> Effect:
            if printed is None:
                raise Refused(f"This command cannot run here. Type it in a second terminal: {line}")
            return Tell(line, [Picture(tuple(printed.splitlines()), indent=0)]) if printed else None

        return Show(RunCommand(line, folder, command.kind is CommandKind.ALONE), ended)

    def film(self) -> Effect:
        scene, session = self.step.own_agent, self.session
        assert scene is not None  # else it is not possible
        self._film = None  # also where these lines fail

        def shown(film: OwnAgentFilm) -> Effect:
            if self.step.own_agent is not scene:  # another step is looked at by now
                return None
            self._film, self._drive_follows, self._looks_at = film, True, "film"
            self.stage.learn(film.scene)
            return Show(Replay(film.file)) if self.stage.is_described else None

        files = [session.exercise_file(each) for each in session.lesson.exercises if each.name in scene.own]
        note = "Your lines learn the floor, off screen ..."
        return Work(note, lambda tell: make_film(scene, files, session.own_code_level, tell), shown)

    def explain_second_terminal(self) -> Effect:
        return Tell(SECOND_TERMINAL, [Marked(second_terminal_here(self.session.workspace))])

    def ask_questions(self) -> Effect:
        journal, lesson = self.session.journal, self.session.lesson.name

        def start(bank: Any) -> Effect:
            plan, seed = lesson_plan(bank, lesson), student_seed(journal)
            session = QuizSession(journal, bank, plan, seed=seed)
            if session.current_item is None:  # all were asked: once more, for practice
                session = QuizSession(journal, bank, plan, seed=seed, restart=True)
            return Open(QuizDialogue(session))

        return Work("Reading the questions ...", lambda _: read_bank(), start)

    # The exercise

    def check(self) -> Effect:
        self._work.start()
        return None

    def edit(self) -> Effect:
        return self._choose_file(Edit)

    def edit_here(self) -> Effect:
        return self._choose_file(EditHere)

    def look_at_code(self) -> Effect:
        self.is_at_code = not self.is_at_code
        return None

    def _choose_file(self, request: type[Edit | EditHere]) -> Effect:
        """Asks which of several files is to be opened."""
        work = self._work
        files = work.files(self.step.text) if work.has_others else []
        if len(files) < 2:
            return self._open_file(request, work, work.edited_file)
        options = [Option(each.relative_to(work.file.parent).as_posix()) for each in files]
        suggested = work.suggested_file(self.step.text)
        return Choose(
            "Which file?",
            options,
            lambda index: None if index is None else self._open_file(request, work, files[index]),
            files.index(suggested) if suggested in files else 0,
        )

    def _open_file(self, request: type[Edit | EditHere], work: ExerciseAttempt, file: Path) -> Effect:
        work.choose(file)
        return Show(request(file, work.line_to_edit), self._edited)

    def _edited(self, problem: str) -> Effect:
        if problem:
            raise Refused(problem)
        return self.poll()

    def hint(self) -> Effect:
        self._looks_at = "hint"
        self._newest_hint = self.session.next_hint(self._work.exercise)
        return None

    def drive(self) -> Effect:
        work, scene = self._work, self.step.scene
        assert scene is not None

        def driven(problem: str | None) -> Effect:
            if problem:
                raise Refused(f"The drive could not be saved: {problem}")
            if problem is not None and self.work is work:
                work.start()
            return None

        return Show(Drive(scene, work.file), driven)

    def replay(self) -> Effect:
        work = self._work
        picture = Tell("What went wrong", [Picture(tuple(work.picture_lines), indent=0)])
        if work.recorded_run is None:
            return picture

        def replayed(problem: str) -> Effect:
            if problem and not work.picture_lines:
                raise Refused(f"The run cannot be replayed: {problem}")
            return picture if problem else None

        return Show(Replay(work.recorded_run), replayed)

    def show_output(self) -> Effect:
        return Tell("What your program printed", [Picture(tuple(self._work.printed_lines), indent=0)])

    def show_solution(self) -> Effect:
        files = self.session.open_solution(self._work.exercise)
        if not files:
            raise Refused("No solution came with this kit.")
        blocks: list[Block] = []
        for name, text in files.items():
            blocks += [Text(f"--- {name}", Tone.BOLD)] if len(files) > 1 else []
            blocks.append(Picture(tuple(text.expandtabs(4).splitlines()), indent=0))
        return Tell(f"Reference solution: {next(iter(files))}", blocks)

    def defend(self) -> Effect:
        session, exercise = self.session, self._work.exercise

        def ask(defence: Defence) -> Effect:
            return Open(DefenceDialogue(session, exercise, defence))

        note = "Running your program once, off screen, from a new start ..."
        return Work(note, lambda _: session.prepare_defence(exercise), ask)

    def start_over(self) -> Effect:
        kept = self._work.start_over()
        self._looks_at = ""
        return Remark(
            f"Started over. Your files are kept in {kept.name}, beside it." if kept else "Started over."
        )

    @property
    def _work(self) -> ExerciseAttempt:
        assert self.work is not None  # the actions of an exercise are not possible elsewhere
        return self.work

    # When

    def can_predict(self) -> bool | str:
        if self.has_ended or not self.step.options:
            return False
        if self.chosen is None:
            return True
        return f"You have predicted {self.step.options.index(self.chosen) + 1}; only the first choice counts."

    def can_ask_questions(self) -> bool | str:
        return self.has_ended or f"The questions come after step {len(self.session.lesson.steps)}, the last."

    def can_go_on(self) -> bool | str:
        if self.has_ended:
            return self._next_lesson is not None
        if self.is_waiting:
            return f"Predict first, 1 to {len(self.step.options)}: a wrong guess costs nothing."
        return True

    def can_go_back(self) -> bool | str:
        return self.has_ended or self.step.number > 1 or "This is the first step."

    def can_restart(self) -> bool | str:
        if self.has_scene and not self.is_still:
            return True
        if self.is_waiting:
            return f"Predict first, 1 to {len(self.step.options)}: a wrong guess costs nothing."
        if self.work is None:
            return False
        return (
            "Press d to drive; r restarts the drive there."
            if self.work.by_hand
            else "c checks the exercise, x starts it over."
        )

    def can_pause(self) -> bool:
        return self.is_playing_back and not self.stage.is_resting

    def can_step(self) -> bool:
        return self.is_playing_back and self.stage.is_paused

    def has_commands(self) -> bool:
        return not self.has_ended and bool(self.step.runnable_commands)

    def has_beside(self) -> bool:
        return not self.has_ended and any(each.kind is not CommandKind.SCREEN for each in self.step.commands)

    def can_check(self) -> bool | str:
        if self.work is None:
            return False
        return self.work.has_driven or "You have not driven yet: press d."

    def can_edit(self) -> bool:
        return self.work is not None and not self.work.by_hand

    def can_look_at_code(self) -> bool:
        return self.can_edit() and (self.is_code_cut or self.is_at_code)

    def can_hint(self) -> bool | str:
        if self.work is None:
            return False
        report = self.report
        if report is None:
            return "Check first (c): hints are for criteria that you missed."
        if self.session.has_closed_hints(self.work.exercise):
            return True
        if self.session.opened_hints(self.work.exercise):
            return "You have seen all hints; they stand below what was missed."
        return "Nothing was missed." if report.is_passed else "There is no hint for this."

    def can_drive(self) -> bool:
        return self.work is not None and self.work.by_hand and self.step.scene is not None

    def can_replay(self) -> bool | str:
        if self.work is None:
            return False
        has_run = self.work.recorded_run is not None or bool(self.work.picture_lines)
        if has_run:
            return True
        if self.report is not None and self.report.criteria:
            return "This check recorded no run."
        return "No run was recorded yet: c checks the exercise."

    def can_show_output(self) -> bool | str:
        if self.work is None or self.work.by_hand:
            return False
        if self.work.printed_lines:
            return True
        return (
            "Your program printed nothing."
            if self.report is not None
            else "Your program has not run yet: c checks it."
        )

    def can_show_solution(self) -> bool | str:
        if self.work is None:
            return False
        return self.session.can_see_solution(self.work.exercise) or "The solution is shown once yours passes."

    def can_film(self) -> bool | str:
        scene = self.step.own_agent
        if self.has_ended or scene is None:
            return False
        lacking = [
            str(step.number)
            for step in self.session.lesson.steps
            if step.exercise is not None
            and step.exercise.name in scene.own
            and not self.session.can_see_solution(step.exercise)
        ]
        return (
            not lacking
            or f"First pass the exercise of step {' and of step '.join(lacking)}: its lines learn here."
        )

    def can_defend(self) -> bool | str:
        if self.work is None or not self.work.exercise.is_program:
            return False
        if self.session.can_defend(self.work.exercise):
            return True
        if self.session.can_see_solution(self.work.exercise):
            return "There are no questions about this program: its check recorded no drive."
        return "First pass the exercise with a program that drives."

    def has_work(self) -> bool:
        return self.work is not None

    def next_word(self) -> str:
        return "next lesson" if self.has_ended else "next"

    def back_word(self) -> str:
        return "back, which ends the check" if self.busy or self.checked_elsewhere else "back"

    def predict_keys(self) -> str:
        return f"1-{len(self.step.options)}"

    actions: ClassVar[Sequence[DialogueAction[Any]]] = (
        DialogueAction(
            ScreenAction("predict", "1 2 3 4", "predict", "predict; your first choice counts", digits("predict", 1, 4), "1-4"),
            predict, can_predict, shown_keys=predict_keys,
        ),
        DialogueAction(
            ScreenAction("drive_scene", "arrows", "drive", "drive the robot, in a scene that waits for you", (), "←↑↓→"),
            lambda dialogue: None, lambda dialogue: dialogue.is_driving, is_for_lines=False,
        ),
        DialogueAction(ACTIONS["check"], check, can_check),
        DialogueAction(ACTIONS["edit_file"], edit, can_edit),
        DialogueAction(
            ACTIONS["editor"], edit_here, can_edit, word=lambda dialogue: "write", is_for_lines=False, while_busy=True
        ),
        DialogueAction(ACTIONS["hint"], hint, can_hint),
        DialogueAction(ACTIONS["drive"], drive, can_drive),
        DialogueAction(ACTIONS["replay"], replay, can_replay),
        DialogueAction(ACTIONS["solution"], show_solution, can_show_solution),
        DialogueAction(ACTIONS["next"], go_on, can_go_on, word=next_word, while_busy=True),
        DialogueAction(letter("run_command", "o", "run", "run a command of this step here"), run_command, has_commands),
        DialogueAction(
            letter("code", "Tab", "code", "read the program, or the task", name="tab"), look_at_code, can_look_at_code,
            word=lambda dialogue: "task" if dialogue.is_at_code else "code", is_for_lines=False, while_busy=True,
        ),
        DialogueAction(ACTIONS["defend"], defend, can_defend),
        DialogueAction(letter("film", "d", "film", "let your own lines learn the floor, and drive"), film, can_film),
        DialogueAction(ACTIONS["second_terminal"], explain_second_terminal, has_beside),
        DialogueAction(ACTIONS["output"], show_output, can_show_output),
        DialogueAction(
            letter("questions", "k", "questions", "answer the lesson's questions, after its last step"),
            ask_questions, can_ask_questions,
        ),
        DialogueAction(ACTIONS["previous"], go_back, can_go_back, while_busy=True),
        DialogueAction(ACTIONS["restart"], restart, can_restart),
        DialogueAction(ACTIONS["pause"], pause, can_pause, is_for_lines=False),
        DialogueAction(ACTIONS["step"], step_once, can_step, is_for_lines=False),
        DialogueAction(
            ACTIONS["start_over"], start_over, has_work,
            confirm="x once more starts this exercise over; your files are kept beside it.",
        ),
        help_action(),
        leave_action(lambda dialogue: Leave(), back_word),
        DialogueAction(ACTIONS["steps"], go_to, takes_text=True, is_listed=False, while_busy=True),
        DialogueAction(ACTIONS["quit"], lambda dialogue: Leave(), is_listed=False, is_for_lines=False, while_busy=True),
        glossary_action(),
    )  # fmt: skip


def _load_run(file: Path) -> tuple[Recording, Scenario] | None:
    """A recorded run and where it was driven; None where nothing moves, as there is nothing to see, and where either cannot be
    read: a pass is a pass, whatever the world or the disk does to its picture. Slow: the physics takes a moment to import."""
    from kit.run.recording import load_recording

    try:
        recording = load_recording(file)
        return (recording, find_scenario(recording.place, recording.case)) if recording.moves() else None
    except Exception:  # noqa: BLE001 - as above
        return None

"""``kit lesson`` and ``kit glossary``: lists the lessons, runs one on the full screen or line by line, explains their terms."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from kit.cli import VERBS, messages, opening, options, terminal_options
from kit.cli.dialogue import Way, run_dialogue
from kit.cli.existing_path import ExistingPath
from kit.cli.full_screen import show_lesson, show_lessons
from kit.cli.input_lines import InputBuffer
from kit.cli.plain import HEIGHT, WIDTH, PlainSession, run_plain_session
from kit.controllers import find_controller, prepare_workspace
from kit.document.blocks import Block, Text, Tone, labelled_table
from kit.document.layout import lines_of
from kit.extensions import folders
from kit.plain_text import counted, escape_controls, quoted, suggestion, wrap
from kit.render.world_text import describe_scene, scene_rows
from kit.run.episode import run_until, when_failed
from kit.run.recording import RecordingError, load_recording
from kit.run.scenario import find_scenario
from kit.run.session import Session
from kit.run.view import ViewBuilder
from kit.school.lessons.aside import arguments_of, editor_arguments, keys_of_vi
from kit.school.lessons.catalogue import list_lessons
from kit.school.lessons.checking import ExerciseFilesError
from kit.school.lessons.glossary import UnknownTerm, find_terms, glossary_blocks, read_glossary
from kit.school.lessons.graph_playback import graph_rows
from kit.school.lessons.learning_playback import plain_rows
from kit.school.lessons.lesson_contract import check_contract, lesson_folders
from kit.school.lessons.lesson_dialogue import Drive, Edit, LessonDialogue, Replay, RunCommand
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import UnknownLesson, find_lesson, read_lesson
from kit.school.lessons.records import (
    GraphScene,
    LearningScene,
    Lesson,
    LessonScene,
    LessonStep,
    scene_confinement_level,
)
from kit.school.progress import ProgressError, ProgressJournal
from kit.workspace import Workspace, WorkspaceError
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Scenario

TRAIL_POINTS = 100
"""Points of the way that a recorded run is drawn with."""


@click.command()
@click.argument("name", required=False)
@options.workspace
@click.option(
    "--from",
    "folder",
    metavar="FOLDER",
    type=ExistingPath(file_okay=False, path_type=Path),
    help="Use someone else's lessons: texts are Markdown, programs run confined.",
)
@click.option(
    "--check",
    "contract_folder",
    metavar="FOLDER",
    type=ExistingPath(file_okay=False, path_type=Path),
    help="Check that your own lessons work with --from.",
)
@click.option(
    "--plain",
    is_flag=True,
    help="Print lines of text instead of a full screen: for screen readers and pipes.",
)
@click.option(
    "--as-class",
    is_flag=True,
    help="Check your work at the confinement level used for class grading (default: level 0, which is faster).",
)
@terminal_options.glyphs
@terminal_options.color
def command(
    name: str | None,
    workspace: Path | None,
    folder: Path | None,
    contract_folder: Path | None,
    plain: bool,
    as_class: bool,
    glyphs: str | None,
    color: str | None,
) -> None:
    """List the lessons, or take one: predict, run, explain, modify, make.

    \b
    kit lesson            list the lessons and your progress
    kit lesson A2         take one, by number or by name: kit lesson drive
    kit lesson --from FOLDER         take the only lesson there, or list them
    kit lesson --from FOLDER NAME    take one of several

    KIT_LANG=pt shows lessons in Portuguese where they are translated.
    Your progress is saved as you go; quit at any time and come back. With KIT_REDUCE_MOTION=1, animations show only
    their first and last picture; --plain describes them in words.
    """
    if contract_folder is not None:
        _print_contract(contract_folder)
    try:
        if folder is not None and name is None and (name := _only_lesson(folder)) is None:
            return
        opened_workspace = prepare_workspace(workspace)
        with opening.open_journal(opened_workspace) as journal:
            terminal = terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
            if name is None:
                if not terminal.plain.value:
                    show_lessons(opened_workspace, terminal)
                _print_lessons(journal)
                return
            lesson = _lesson(name) if folder is None else _foreign_lesson(folder, name)
            session = LessonSession(lesson, journal, opened_workspace, as_class=as_class)
            if not terminal.plain.value:
                show_lesson(session, opened_workspace, terminal)
            click.echo(f"Line by line. {terminal.plain.reason}")
            dialogue = LessonDialogue(session)
            dialogue.begin(LineStage())
            run_dialogue(dialogue, _request_handlers(opened_workspace))
    except (
        UnknownLesson,
        WorkspaceError,
        ProgressError,
        ExerciseFilesError,
        WorldError,
        FileNotFoundError,
    ) as error:
        messages.fail(str(error))


def _print_contract(folder: Path) -> NoReturn:
    """Prints what was checked of the lessons in a folder. Exit code: 0 all is kept, 1 not, 2 there is no lesson."""
    findings = []
    for each in check_contract(folder, VERBS):
        findings.append(each)
        click.echo(escape_controls(f"{'[ok]' if each.is_kept else '[no]'} {each.lesson}: {each.text}"))
        for line in each.problem.splitlines():
            click.echo(f"     {escape_controls(line)}")
    if not findings:
        messages.fail(f"{folder}: there is no lesson.yaml in it or in a folder below it.")
    broken = sum(not each.is_kept for each in findings)
    click.echo(f"\n{counted(len(findings), 'thing')} checked, {broken} to fix.")
    raise SystemExit(1 if broken else 0)


def _only_lesson(folder: Path) -> str | None:
    """The only lesson in a folder; else prints which there are."""
    found = lesson_folders(folder)
    if not found:
        messages.fail(f"{folder}: there is no lesson.yaml in it or in a folder below it.")
    if len(found) == 1:
        return found[0].name
    for each in found:
        click.echo(escape_controls(each.name))
    click.echo(f"\n`kit lesson --from {folder} NAME` opens one.")
    return None


def _lesson(name: str) -> Lesson:
    """The kit's lesson of that name, or that of another package. Raises UnknownLesson and WorldError."""
    try:
        return find_lesson(name)
    except UnknownLesson:
        for _, folder in folders("lessons"):
            if name in (each.name for each in lesson_folders(folder)):
                return _foreign_lesson(folder, name)
        raise


def _foreign_lesson(folder: Path, name: str) -> Lesson:
    """The lesson of that name in a folder of somebody else's. Raises UnknownLesson and WorldError."""
    found = {each.name: each for each in lesson_folders(folder)}
    if name not in found:
        raise UnknownLesson(f"{folder} has no lesson {quoted(name)}: {suggestion(name, tuple(found))}")
    return read_lesson(found[name], is_foreign=True)


def _print_lessons(journal: ProgressJournal) -> None:
    blocks: list[Block] = []
    for each in list_lessons(journal.events()):
        if (unit := each.opened_unit) is not None:
            blocks += [Text(f"{unit.letter}  {unit.title}", Tone.BOLD), Text(unit.opener, is_tight=True)]
        progress = each.progress
        if progress is None:
            blocks += [Text(f"{each.name}: cannot be read."), Text(each.problem, indent=4, is_tight=True)]
            continue
        lesson, done = progress.lesson, f"{progress.completed_count}/{len(progress.lesson.steps)}"
        mark = "  done" if each.is_completed else f"  {done}" if each.has_started else ""
        tail = f"  {lesson.minutes} min{mark}"
        blocks.append(Text(lesson.title, Tone.BOLD, lead=f"{each.number:<3}", tail=tail))
        blocks.append(Text(lesson.summary, indent=4, is_tight=True))
    others = [
        (each.name, f"from {part.source}")
        for part, folder in folders("lessons")
        for each in lesson_folders(folder)
    ]
    if others:
        blocks.append(labelled_table(others, "Of other packages:", indent=2))
    click.echo("\n".join(lines_of([*blocks, Text("`kit lesson NUMBER` opens one.")])))


def _request_handlers(workspace: Workspace) -> dict[type, Way]:
    """For each request of a lesson, the function that carries it out line by line."""
    return {
        Drive: lambda request, lines: _drive_scene(request, workspace, lines),
        Replay: lambda request, lines: _print_run(request.file),
        Edit: lambda request, lines: _edit(request),
        RunCommand: lambda request, lines: _run_command(request, workspace),
    }


def _edit(request: Edit) -> str:
    """Opens the student's editor, and waits for its end; returns why it could not."""
    arguments = editor_arguments(os.environ, request.file, request.line)
    if arguments is None or not sys.stdin.isatty():
        return f"No editor can be opened here. Edit {request.file} in another terminal; saving it checks it."
    try:
        if keys := keys_of_vi(os.environ, arguments):
            click.echo("\n".join(wrap(keys, WIDTH)))
            input("Enter opens it. ")
        subprocess.run(arguments, cwd=request.file.parent, check=False)
    except EOFError:
        return ""
    except OSError as error:
        return f"{arguments[0]} could not be started ({error.strerror}). Name another editor in $EDITOR."
    return ""


def _run_command(request: RunCommand, workspace: Workspace) -> str | None:
    """Runs a command of the kit in this terminal."""
    arguments = arguments_of(request.line)
    if arguments is None:
        return None
    click.echo(f"$ {request.line}")
    sys.stdout.flush()
    source = None if sys.stdin is not None and sys.stdin.isatty() else subprocess.DEVNULL
    environment = {**os.environ, "KIT_WORKSPACE": str(workspace.folder)}
    subprocess.run(arguments, cwd=request.folder, env=environment, stdin=source, check=False)
    return ""


class LineStage:
    """Tells the scene of a step in words and a picture, its beginning and its end."""

    is_described = is_open = is_resting = True
    is_recorded = is_paused = is_roomy = False

    def __init__(self) -> None:
        self._scene: LessonScene | LearningScene | GraphScene | None = None

    def open(self, step: LessonStep, *, still: bool) -> None:
        self._scene = step.scene or step.playback_scene

    def play(self, recording: Recording, place: Scenario, *, still: bool = False) -> None: ...

    def learn(self, scene: LearningScene) -> None:
        self._scene = scene
        self.replay()

    def go(self) -> None:
        self.replay()

    def replay(self) -> None:
        if self._scene is not None:
            _print_watched(self._scene)

    def set_paused(self, paused: bool) -> None: ...

    def step_once(self) -> None: ...

    def close(self) -> None: ...


def _print_watched(scene: LessonScene | LearningScene | GraphScene) -> None:
    """Prints what a step has to watch."""
    if isinstance(scene, LearningScene):
        click.echo("\n".join(plain_rows(scene)))
    elif isinstance(scene, GraphScene):
        click.echo("\n".join(graph_rows(scene, at_end=True)))
    else:
        _print_scene(scene)


def _print_scene(scene: LessonScene) -> None:
    """Runs a scene and prints it in words and a picture: its beginning and its end."""
    scenario = find_scenario(scene.map_name, scene.case, None)
    with Session(
        scenario, seed=scene.seed, always_scan=True, level=scene_confinement_level(scene)
    ) as session:
        session.drive_with(find_controller(scene.controller, None) if scene.controller else None)
        session.wait_until_driven()
        view_builder = ViewBuilder(session)
        click.echo(f"At the start: {describe_scene(view_builder.build().scene)}")
        run_until(session.runner, limit_s=scene.seconds, ends=(when_failed(session),))
        session.poll()
        view = view_builder.build()
        click.echo("\n".join(scene_rows(view.scene, WIDTH, HEIGHT // 2 + 2)))
        drive_text = f"{view.metrics.distance_m:.1f} m driven, {counted(view.metrics.bumps, 'bump')}"
        click.echo(f"After {scene.seconds:g} s: {describe_scene(view.scene)}; {drive_text}.")


def _print_run(file: Path) -> str:
    """Prints a recorded run in words and a picture: where it began, and how it ended. Returns why that is not possible."""
    try:
        recording = load_recording(file)
        place = find_scenario(recording.place, recording.case)
    except (OSError, LookupError, RecordingError, WorldError) as error:
        return str(error)
    with Session(place, seed=recording.seed, step_size=recording.step_size, always_scan=True) as session:
        session.play_back(recording)
        view_builder = ViewBuilder(session)
        click.echo(f"At the start: {describe_scene(view_builder.build().scene)}")
        for _ in range(TRAIL_POINTS):
            run_until(session.runner, ticks=recording.ticks // TRAIL_POINTS)
            view = view_builder.build()  # each adds a point to the way
        run_until(session.runner, ticks=recording.ticks % TRAIL_POINTS)
        view = view_builder.build()
        click.echo("\n".join(scene_rows(view.scene, WIDTH, HEIGHT // 2 + 2)))
        drive_text = f"{view.metrics.distance_m:.1f} m driven, {counted(view.metrics.bumps, 'bump')}"
        click.echo(f"After {view.time_s:.1f} s: {describe_scene(view.scene)}; {drive_text}.")
    return ""


def _drive_scene(request: Drive, opened_workspace: Workspace, input_buffer: InputBuffer) -> str:
    """Lets the student drive line by line, reading the same input, and saves the recording; returns why that failed."""
    scene = request.scene
    scenario = find_scenario(scene.map_name, scene.case, None)
    click.echo(
        "`drive 0.3 0 2` drives at 0.3 m/s without turning for 2 s; `picture` shows where you are; `quit` hands in your drive."
    )
    try:
        run_plain_session(
            PlainSession(
                scenario,
                find_controller("teleop", opened_workspace.controllers),
                seed=scene.seed,
                folder=opened_workspace.controllers,
                record=opening.open_recording_file(request.file),
                input_buffer=input_buffer,
            )
        )
    except OSError as error:
        return f"{request.file}: {error.strerror}."
    return ""


@click.command()
@click.argument("term", nargs=-1)
def glossary_command(term: tuple[str, ...]) -> None:
    """Explain a TERM used in the lessons, or all terms, and name the lessons that introduce them.

    \b
    kit glossary                    all terms
    kit glossary quality of service one term
    """
    try:
        terms = read_glossary()
        shown = find_terms(terms, " ".join(term)) if term else terms
    except (UnknownTerm, WorldError, FileNotFoundError) as error:
        messages.fail(str(error))
    click.echo("\n".join(lines_of(glossary_blocks(shown))))

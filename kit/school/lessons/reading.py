"""Reads lesson folders into records. Reports every mistake with its file, line and column."""

from __future__ import annotations

import re
import zlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path, PurePosixPath
from string import ascii_uppercase
from typing import Final

from kit.document.markup import BLOCK_INDENT, MarkupError, parse_markup, wrap_blocks
from kit.learning.grid.grid_learner import GridLearnerSettings
from kit.learning.grid.grid_world import GridMapError, GridRewards, GridWorld
from kit.learning.grid.registry import GRID_LEARNERS
from kit.plain_files import is_file_there
from kit.plain_text import nearest_name, quoted, suggestion
from kit.results.grading_result import Visibility
from kit.school.lessons.markdown import markdown_to_markup
from kit.school.lessons.own_learners import OWN_LEARNERS
from kit.school.lessons.records import (
    CommandKind,
    Exercise,
    GraphChannel,
    GraphScene,
    LearningScene,
    Lesson,
    LessonClaim,
    LessonCommand,
    LessonScene,
    LessonStep,
    LessonUnit,
    PredictionOption,
    StepKind,
)
from kit.school.lessons.translation import (
    missing_language,
    translate_lesson,
    translated_criteria,
    translation_of,
)
from kit.world.documents import open_document
from kit.world.problems import WorldError
from kit.world.yaml_section import Section

LESSON_FILE: Final = "lesson.yaml"
OUTCOMES_FILE: Final = "outcomes.yaml"
UNITS_FILE: Final = "units.yaml"
ASSIGNMENT_FILE: Final = "assignment.yaml"
STARTER_FOLDER: Final = "starter"
"""Folder of an exercise whose starter has several files."""

TEXT_WIDTH: Final = 76
"""Characters of a line of text, so that it fits on 80 columns."""
MAX_TEXT_ROWS_WITH_PICTURE: Final = 12
MAX_TEXT_ROWS: Final = 17
MAX_ROWS_WITH_GRAPH: Final = 19
"""Most rows of the text and the graph above it."""
MAX_CHANNELS: Final = 4
MAX_PICTURE_ROWS: Final = 10
MAX_LEARNERS: Final = 2
OPTION_COUNT_RANGE: Final = (2, 4)
_NUMBER_OF: Final = re.compile(r"\{number ([\w-]+)\}")


class UnknownLesson(LookupError):
    """No lesson has that name; the message offers the nearest one."""


def lessons_folder() -> Path:
    """The folder of the lessons: in the installed package, or beside it in a checkout. Raises FileNotFoundError."""
    return _data_folder("lessons", "lessons")


def solutions_folder() -> Path:
    """The folder of the reference solutions. Raises FileNotFoundError if they were not installed."""
    return _data_folder("solutions", "tests/solutions")


def lesson_names(folder: Path | None = None) -> tuple[str, ...]:
    """The names of all lessons, in the order in which to take them: unit by unit, then those of no unit by name."""
    folder = lessons_folder() if folder is None else folder
    found = sorted(each.parent.name for each in folder.glob(f"[!.]*/{LESSON_FILE}"))
    in_units = [name for unit in read_units(folder) for name in unit.lessons if name in found]
    return (*in_units, *(name for name in found if name not in in_units))


def read_units(folder: Path | None = None) -> tuple[LessonUnit, ...]:
    """Reads the units of the course, in order; none where the folder has no ``units.yaml``. Raises WorldError."""
    file = (lessons_folder() if folder is None else folder) / UNITS_FILE
    if not file.is_file():
        return ()
    units = []
    with open_document(file) as section:
        for letter, each in zip(ascii_uppercase, section.sections("units", at_least=1), strict=False):
            units.append(
                LessonUnit(letter, each.name("title"), each.text("opener").strip(), each.names("lessons"))
            )
            each.finish()
    return tuple(units)


def find_lesson(name: str, folder: Path | None = None) -> Lesson:
    """Finds a lesson as ``find_lesson_name`` does. Raises UnknownLesson, and WorldError if its file is wrong."""
    folder = lessons_folder() if folder is None else folder
    names = lesson_names(folder)
    known = find_lesson_name(name, names, folder)
    if known is not None:
        return read_lesson(folder / known)
    raise UnknownLesson(unknown_lesson(name, names, folder))


def unknown_lesson(name: str, names: Sequence[str], folder: Path | None = None) -> str:
    """The error message about a lesson that is none of ``names``: the nearest one by its number in the course.

    >>> unknown_lesson("driv", ("00-what-this-is-about", "01-drive"))
    'There is no lesson "driv": did you mean A2, "Drive"? `kit lesson` lists them.'
    """
    spellings = {
        spelling: known
        for known in names
        for spelling in (known.partition("-")[2], lesson_title(known, folder), known)
    }
    near = nearest_name(name, spellings)
    hint = "."
    if near is not None:
        known = spellings[near]
        hint = f": did you mean {lesson_number(known, folder)}, {quoted(lesson_title(known, folder))}?"
    return f"There is no lesson {quoted(name)}{hint} `kit lesson` lists them."


def find_lesson_name(name: str, names: Sequence[str], folder: Path | None = None) -> str | None:
    """Finds a lesson among ``names``: by its number in the course (``B3``), the name of its folder, the folder's number
    alone, or its name without that number; None if there is none.

    >>> find_lesson_name("a2", ("00-what-this-is-about", "01-drive"))
    '01-drive'
    >>> find_lesson_name("1", ("00-what-this-is-about", "01-drive"))
    '01-drive'
    """
    for known in names:
        first, _, rest = known.partition("-")
        short = str(int(first)) if first.isdecimal() else first
        if name in (known, rest, first, short) or name.upper() == lesson_number(known, folder):
            return known
    return None


def lesson_number(name: str, folder: Path | None = None) -> str:
    """The number of a lesson in the course: the letter of its unit and its place there, ``B3``. Of a lesson of no unit:
    the number of its folder without leading zeros. The folder's number never changes; this one does when lessons are
    added before it. Raises WorldError if the units cannot be read.

    >>> lesson_number("01-drive")
    'A2'
    >>> lesson_number("03-of-somebody-else")
    '3'
    """
    file = (lessons_folder() if folder is None else folder) / UNITS_FILE
    numbers = _numbers_in_units(file.parent, file.stat().st_mtime_ns) if file.is_file() else {}
    first = name.partition("-")[0]
    return numbers.get(name) or (str(int(first)) if first.isdecimal() else first)


def lesson_title(name: str, folder: Path | None = None) -> str:
    """The title of a lesson, in the language of the lessons. Of one that cannot be read: the words of its folder's name.

    >>> lesson_title("07-who-collides-who-sees")
    'Who collides, who sees'
    >>> lesson_title("03-of-somebody-else")
    'of somebody else'
    """
    original = (lessons_folder() if folder is None else folder) / name / LESSON_FILE
    file = translation_of(original) or original
    title = _title_in(file, file.stat().st_mtime_ns) if file.is_file() else ""
    return title or name.partition("-")[2].replace("-", " ")


@lru_cache(maxsize=128)
def _title_in(file: Path, changed_ns: int) -> str:
    """The title in a lesson's file; empty if that cannot be read. ``changed_ns``: when it was changed; part of the key."""
    try:
        with open_document(file, is_partial=True) as section:
            return section.name("title")
    except WorldError:
        return ""


@lru_cache(maxsize=8)
def _numbers_in_units(folder: Path, changed_ns: int) -> Mapping[str, str]:
    """The number of each lesson of a unit. ``changed_ns``: when the file of the units was changed; part of the key."""
    return {
        name: f"{unit.letter}{place}"
        for unit in read_units(folder)
        for place, name in enumerate(unit.lessons, 1)
    }


def with_lesson_numbers(text: str, folder: Path) -> str:
    """Fills in the numbers of lessons: ``{number 01-drive}`` becomes ``A2``. Raises UnknownLesson if there is none of that
    name in ``folder``, the one of all lessons.

    >>> with_lesson_numbers("as in lesson {number 01-drive}", lessons_folder())
    'as in lesson A2'
    """
    for name in _NUMBER_OF.findall(text):
        if not (folder / name / LESSON_FILE).is_file():
            raise UnknownLesson(
                f"there is no lesson {quoted(name)}: {suggestion(name, lesson_names(folder))}"
            )
        text = text.replace(f"{{number {name}}}", lesson_number(name, folder))
    return text


def read_lesson(folder: Path, language: str | None = None, *, is_foreign: bool = False) -> Lesson:
    """Reads the lesson in ``folder``. Raises WorldError with all its mistakes.

    ``is_foreign``: it is not one of the kit's. Then its texts are Markdown, its commands the kit's alone, and its programs
    run as confined as this machine can.

    ``language``: two letters, by default ``KIT_LANG``'s; "" is the original. One that it has no words in is shown in the
    original.
    """
    lesson = _read_original(folder, is_foreign=is_foreign)
    file = translation_of(folder / LESSON_FILE, language)
    if file is None:
        return replace(lesson, missing_language=missing_language(folder / LESSON_FILE, language))
    with open_document(file) as document:
        lesson, translated = translate_lesson(lesson, document)
        steps = [(section, _with_numbers(section, step, folder.parent)) for section, step in translated]
        for section, step in steps:
            _check_step(section, step)
    read = tuple(
        step
        if step.exercise is None
        else replace(step, exercise=_translated_exercise(step.exercise, language))
        for _, step in steps
    )
    return replace(lesson, steps=read)


def _translated_exercise(exercise: Exercise, language: str | None) -> Exercise:
    """The exercise with the words of its assignment's translation; as it is where there is none."""
    original = exercise.folder / ASSIGNMENT_FILE
    file = translation_of(original, language)
    if file is None:
        return exercise
    with open_document(file) as section, open_document(original, is_partial=True) as assignment:
        return replace(exercise, words=translated_criteria(assignment, section))


def _read_original(folder: Path, *, is_foreign: bool) -> Lesson:
    # Progress and files of a lesson from elsewhere must not be taken for those of the kit's lesson of that name.
    elsewhere = f"-{zlib.crc32(str(folder.resolve()).encode()):08x}" if is_foreign else ""
    with open_document(folder / LESSON_FILE) as section:
        lesson = Lesson(
            name=folder.name + elsewhere,
            number=lesson_number(folder.name, folder.parent),
            folder=folder,
            title=section.name("title"),
            summary=section.name("summary"),
            minutes=section.integer("minutes", minimum=1, maximum=120),
            outcomes=section.texts("outcomes", at_least=1),
            outcome_ids=section.texts("carries", ()),
            steps=tuple(_read_steps(section, folder, is_foreign=is_foreign)),
            is_foreign=is_foreign,
        )
        has_outcomes = not is_foreign or (folder.parent / OUTCOMES_FILE).is_file()
        known = read_outcomes(folder.parent) if has_outcomes else {}
        for each in lesson.outcome_ids:
            if each not in known:
                section.error(f"no outcome {quoted(each)}: {suggestion(each, known)}", "carries")
    return lesson


def exercise_scene(exercise: Exercise) -> LessonScene | None:
    """The world in which the check first drives the student's program, with nobody driving; None where it drives in none that has
    a name, and where the assignment cannot be read, which its check tells."""
    try:
        with open_document(exercise.folder / ASSIGNMENT_FILE, is_partial=True) as section:
            trial = next((each for each in section.sections("trials", ()) if each.has("place")), None)
            if trial is None:
                return None
            case = trial.name("case") if trial.has("case") else None
            return LessonScene(trial.name("place"), case, "", 1, trial.number("time", 10.0, above=0))
    except WorldError:
        return None


def exercise_criteria(exercise: Exercise) -> list[tuple[str, float]]:
    """The titles of what the check looks at, each with its points, in the language of the lesson; without what is not shown to
    students, and none where the assignment cannot be read, which its check tells."""
    try:
        with open_document(exercise.folder / ASSIGNMENT_FILE, is_partial=True) as section:
            shown = [
                each
                for each in section.sections("checks", ())
                if each.text("visibility", Visibility.VISIBLE.value) == Visibility.VISIBLE
                and each.has("title")
            ]
            told = [(each.name("title"), each.number("points", 0.0, minimum=0)) for each in shown]
    except WorldError:
        return []
    return [(exercise.words.get(" ".join(title.split()), title), points) for title, points in told]


def read_outcomes(folder: Path | None = None) -> Mapping[str, str]:
    """Reads the outcomes and practical concepts that lessons refer to, by id. Raises WorldError."""
    with open_document((lessons_folder() if folder is None else folder) / OUTCOMES_FILE) as section:
        return {key: section.text(key) for key in tuple(section.keys())}


def _data_folder(installed: str, checkout: str) -> Path:
    package = Path(__file__).resolve().parents[2]
    for folder in (package / "data" / installed, package.parent / checkout):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"{installed} are missing: neither in {package / 'data'} nor beside {package}")


def _read_steps(section: Section, folder: Path, *, is_foreign: bool) -> Iterator[LessonStep]:
    seen: set[str] = set()
    for number, each in enumerate(section.sections("steps", at_least=1), 1):
        kind = each.choice("kind", {one.value: one for one in StepKind})
        scene = _read_scene(each, folder)
        picture = each.text("picture", "").rstrip("\n")
        step = LessonStep(
            number=number,
            kind=StepKind.EXPLAIN if kind is None else kind,
            title=each.name("title"),
            goal=each.name("goal"),
            text=markdown_to_markup(each.text("text")) if is_foreign else each.text("text").strip("\n"),
            scene=scene if scene is None else replace(scene, is_foreign=is_foreign),
            picture=picture,
            commands=tuple(_read_commands(each)),
            question=each.text("question", ""),
            options=tuple(_read_options(each)),
            exercise=_read_exercise(each, folder, seen),
            claims=tuple(_read_claims(each)),
            learning=_read_learning(each, seen),
            graph=_read_graph(each),
        )
        step = _with_numbers(each, step, folder.parent)
        if is_foreign:
            for command in step.commands:
                if command.line.split()[:1] != ["kit"]:
                    each.error(f"{quoted(command.line)} is not a command of the kit", "commands")
        _check_step(each, step)
        each.finish()
        yield step


def _with_numbers(section: Section, step: LessonStep, folder: Path) -> LessonStep:
    """Inserts the numbers of the lessons that a step names; ``folder``: the folder of all lessons."""
    try:
        return replace(
            step,
            text=with_lesson_numbers(step.text, folder),
            question=with_lesson_numbers(step.question, folder),
            options=tuple(
                replace(
                    option,
                    text=with_lesson_numbers(option.text, folder),
                    feedback=with_lesson_numbers(option.feedback, folder),
                )
                for option in step.options
            ),
        )
    except UnknownLesson as error:
        section.error(str(error))
        return step


def _check_step(section: Section, step: LessonStep) -> None:
    """Reports parts that a step of this kind lacks or must not have, and text that does not fit on a screen."""
    predicts = step.kind is StepKind.PREDICT
    if predicts != bool(step.options) or predicts != bool(step.question):
        section.error("a step to predict, and no other, has a question and options")
    elif predicts and sum(option.is_right for option in step.options) != 1:
        section.error("exactly one option must be right", "options")
    works = step.kind in (StepKind.MODIFY, StepKind.MAKE)
    if works != (step.exercise is not None):
        section.error("a step to modify or to make, and no other, has an exercise")
    if sum(each is not None for each in (step.scene, step.learning, step.graph)) + bool(step.picture) > 1:
        key = "picture" if step.picture else "scene"
        section.error("a step has one of scene, learning, graph and picture", key)
    for claim in step.claims:
        if claim.words not in step.wording:
            section.error(f"the step does not say {quoted(claim.words)}", "claims")
    lines = step.picture.splitlines()
    if len(lines) > MAX_PICTURE_ROWS or any(len(line) > TEXT_WIDTH for line in lines):
        section.error(f"a picture has at most {MAX_PICTURE_ROWS} rows of {TEXT_WIDTH} characters", "picture")
    most = MAX_TEXT_ROWS_WITH_PICTURE if step.moves or step.picture else MAX_TEXT_ROWS
    if step.graph is not None:  # is low
        most = MAX_ROWS_WITH_GRAPH - step.graph.least_rows
    try:
        count = len(wrap_blocks(parse_markup(step.text), TEXT_WIDTH))
    except MarkupError as error:
        section.error(str(error), "text")
        return
    if (wide := next(_wide_code(step), None)) is not None:
        section.error(
            f"a row of code has at most {TEXT_WIDTH} characters, unless it is a command: {quoted(wide)}",
            "text",
        )
    if count > most:
        section.error(
            f"the text has {count} rows of {TEXT_WIDTH} characters; at most {most} fit on the screen", "text"
        )


def _wide_code(step: LessonStep) -> Iterator[str]:
    """Rows of code that a screen of 80 columns breaks. A command goes on in the next row, as a shell reads it."""
    commands = {each.line for each in step.commands}
    for block in parse_markup(step.text):
        if block.kind == "code":
            yield from (
                row
                for row in block.lines
                if len(row) > TEXT_WIDTH - len(BLOCK_INDENT) and row not in commands
            )


def _read_scene(section: Section, folder: Path) -> LessonScene | None:
    scene_section = section.section("scene", None)
    if scene_section is None:
        return None
    scene = LessonScene(
        _own_file(scene_section.name("place"), folder),
        scene_section.name("case") if scene_section.has("case") else None,
        _own_file(scene_section.text("controller", ""), folder),
        scene_section.integer("seed", 1, minimum=0),
        scene_section.number("seconds", 10.0, above=0, maximum=600),
    )
    scene_section.finish()
    return scene


def _read_learning(section: Section, exercises: Collection[str]) -> LearningScene | None:
    """``exercises``: names of those of the steps before."""
    scene = section.section("learning", None)
    if scene is None:
        return None
    learners = tuple(_read_learners(scene))
    curve_low, curve_high = (
        scene.number(key) if scene.has(key) else None for key in ("curve_low", "curve_high")
    )
    read = LearningScene(
        _read_grid_world(scene),
        tuple(settings for settings, _ in learners),
        tuple(title for _, title in learners),
        scene.integer("episodes", 0, minimum=0, maximum=2000),
        scene.number("seconds", 20.0, above=0, maximum=120),
        scene.choice("curve", {"steps": "steps", "return": "return"}, "steps"),
        curve_low,
        curve_high,
        scene.integer("curve_mean", 1, minimum=1),
        scene.integer("updates", 0, minimum=0, maximum=20_000),
        scene.texts("own", ()),
    )
    for name in read.own:
        if name not in exercises:
            scene.error(f"no step before this one has the exercise {quoted(name)}", "own")
    if read.own and (
        len(read.learners) > 1 or not read.updates or read.learners[0].algorithm not in OWN_LEARNERS
    ):
        known = ", ".join(OWN_LEARNERS)
        scene.error(
            f"own lines are those of one learner ({known}), and updates says how long it learns", "own"
        )
    if (read.episodes > 0) == (read.updates > 0):
        scene.error("either episodes or updates says how long the learners learn", "episodes")
    scene.finish()
    return read


def _read_graph(section: Section) -> GraphScene | None:
    graph = section.section("graph", None)
    if graph is None:
        return None
    seconds = graph.number("seconds", 12.0, above=0, maximum=120)
    channels: list[GraphChannel] = []
    for each in graph.sections("topics", ()):
        sender, receivers = each.name("publisher"), each.texts("subscribers", ())
        channels.append(_read_channel(each, sender, receivers, seconds, is_service=False))
    for each in graph.sections("services", ()):
        sender, server = each.name("client"), each.name("server")
        channels.append(_read_channel(each, sender, (server,), seconds, is_service=True))
    if not 1 <= len(channels) <= MAX_CHANNELS:
        graph.error(f"a graph has 1 to {MAX_CHANNELS} topics and services", "topics")
    graph.finish()
    return GraphScene(tuple(channels), seconds)


def _read_channel(
    section: Section, sender: str, receivers: tuple[str, ...], seconds: float, *, is_service: bool
) -> GraphChannel:
    rate = section.number("rate", above=0, maximum=1000) if section.has("rate") else None
    times = section.numbers("times", ())
    undelivered = section.texts("undelivered", ())
    channel = GraphChannel(
        section.name("name"),
        sender,
        receivers,
        rate,
        tuple(times),
        is_service,
        undelivered,
        section.text("asked", ""),
    )
    if not set(undelivered) <= set(receivers):
        section.error("undelivered names receivers", "undelivered")
    if (rate is None) != bool(times):
        section.error("either a rate or times say when something is sent", "rate")
    if any(not 0 < time <= seconds for time in times):
        section.error(f"a time is above 0 and at most the {seconds:g} s of the graph", "times")
    for name in (channel.name, sender, *receivers):
        if not name.startswith("/"):
            section.error(f"{quoted(name)} is not a full name: a full name begins with /", "name")
    section.finish()
    return channel


def _read_grid_world(scene: Section) -> GridWorld:
    section = scene.section("rewards", None)
    rewards = GridRewards()
    if section is not None:
        rewards = GridRewards(
            section.number("step", rewards.step),
            section.number("target", rewards.target),
            section.number("small_target", rewards.small_target),
            section.number("cliff", rewards.cliff),
        )
        section.finish()
    try:
        return GridWorld(tuple(scene.text("map").split()), rewards)
    except GridMapError as error:
        scene.error(str(error), "map")
        return GridWorld(("SG",))


def _read_learners(scene: Section) -> Iterator[tuple[GridLearnerSettings, str]]:
    sections = scene.sections("learners", at_least=1)
    if len(sections) > MAX_LEARNERS:
        scene.error(f"at most {MAX_LEARNERS} learners fit beside each other", "learners")
    known = GridLearnerSettings()
    for each in sections:
        algorithm = each.choice("algorithm", {name: name for name in GRID_LEARNERS}, known.algorithm)
        settings = GridLearnerSettings(
            algorithm,
            each.number("alpha", known.alpha, above=0, maximum=10),
            each.number("gamma", known.gamma, minimum=0, maximum=1),
            each.number("epsilon", known.epsilon, minimum=0, maximum=1),
            each.integer("seed", known.seed, minimum=0),
            each.integer("replay", known.replay, minimum=1, maximum=100_000),
            each.integer("target_interval", known.target_interval, minimum=1),
            each.integer("worlds", known.worlds, minimum=1, maximum=64),
            each.number("clip", known.clip, minimum=0, maximum=1),
            each.number("entropy", known.entropy, minimum=0, maximum=1),
            each.number("temperature", known.temperature, minimum=0, maximum=1e6),
            each.number("value_limit", known.value_limit, minimum=0, maximum=1e9),
        )
        yield settings, each.text("title", settings.algorithm)
        each.finish()


def _own_file(name: str, folder: Path) -> str:
    """The path of the file of the lesson's folder with that name; the name itself if there is none."""
    if not name:
        return name
    file = (folder / name).resolve()
    return str(folder / name) if file.exists() and file.is_relative_to(folder.resolve()) else name


def _read_commands(section: Section) -> Iterator[LessonCommand]:
    for each in section.sections("commands", ()):
        how = each.choice("how", {one.value: one for one in CommandKind}, CommandKind.ALONE.value)
        yield LessonCommand(
            each.name("line"),
            how,
            each.text("place", "maze"),
            each.texts("shows") if each.has("shows") else (),
        )
        each.finish()


def _read_options(section: Section) -> Iterator[PredictionOption]:
    sections = section.sections("options", ())
    if sections and not OPTION_COUNT_RANGE[0] <= len(sections) <= OPTION_COUNT_RANGE[1]:
        section.error(f"there must be {OPTION_COUNT_RANGE[0]} to {OPTION_COUNT_RANGE[1]} options", "options")
    for each in sections:
        yield PredictionOption(each.text("text"), each.flag("right", False), each.text("feedback"))
        each.finish()


def _read_claims(section: Section) -> Iterator[LessonClaim]:
    for each in section.sections("claims", ()):
        yield LessonClaim(" ".join(each.text("words").split()), each.name("derived"))
        each.finish()


def _read_exercise(section: Section, folder: Path, seen: set[str]) -> Exercise | None:
    if not section.has("exercise"):
        return None
    name = section.name("exercise")
    exercise = Exercise(
        name,
        folder / name,
        section.name("file"),
        section.number("seconds", 10.0, above=0, maximum=120),
        section.text("edit", ""),
    )
    for key, path in (("file", PurePosixPath(exercise.file)), ("edit", PurePosixPath(exercise.edited_first))):
        if path.is_absolute() or ".." in path.parts:  # it is written in the student's workspace
            section.error(f"{quoted(str(path))} leads out of the exercise's folder", key)
    if exercise.edited_first and not is_file_there(exercise.folder / STARTER_FOLDER / exercise.edited_first):
        section.error(f"the starter has no file {quoted(exercise.edited_first)}", "edit")
    if name in seen:
        section.error(f"the exercise {quoted(name)} has a step already", "exercise")
    elif "/" in name or name.startswith(".") or not is_file_there(exercise.folder / ASSIGNMENT_FILE):
        section.error(f"there is no {name}/{ASSIGNMENT_FILE} beside this file", "exercise")
    seen.add(name)
    return exercise

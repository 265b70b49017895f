"""Challenges of the game without driving: break a reward, beat a layer plan, train within a budget, mount the fewest lasers, repair a launch file."""

from __future__ import annotations

import json
import math
import time
from collections import deque
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final, TypeAlias

from kit.layers.assignment import LayerAssignment, NamedLayer, find_breaches
from kit.layers.cover import minimum_cover
from kit.layers.planning import solve_layers
from kit.layers.requirements import LayerCase
from kit.layers.requirements_file import read_requirements
from kit.plain_text import quoted, suggestion
from kit.school.game.levels import all_levels
from kit.school.game.player_progress import GameSummary, Medal, level_progress
from kit.school.lessons.checking import ExerciseCheck
from kit.school.lessons.reading import lessons_folder
from kit.school.lessons.records import Exercise
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.world.documents import open_document
from kit.world.yaml_section import Section

WALL: Final = "#"
STEPS_PER_SQUARE: Final = 10
"""A line of sight is looked at so often on the length of a square."""
MAX_DEVICES: Final = 100

Square = tuple[int, int]
"""Row and column, from 0."""


class DevicePlanError(ValueError):
    """An answer is no plan; the message says why."""


@dataclass(frozen=True, slots=True)
class DevicesTask:
    """A drawing: ``#`` wall, lower-case letters the places to be seen, everything else floor."""

    grid: tuple[str, ...]

    @property
    def places(self) -> dict[str, Square]:
        """The places by their letters."""
        return {sign: square for square, sign in self._squares().items() if sign.islower()}

    @property
    def floor(self) -> tuple[Square, ...]:
        """The squares where a laser can be mounted."""
        return tuple(square for square, sign in self._squares().items() if sign != WALL)

    def sees(self, laser: Square, square: Square) -> bool:
        """Whether no wall lies on the straight line between the middles of two squares."""
        steps = STEPS_PER_SQUARE * max(abs(laser[0] - square[0]), abs(laser[1] - square[1]), 1)
        for step in range(steps + 1):
            row, column = (round(a + (b - a) * step / steps) for a, b in zip(laser, square, strict=True))
            if self.grid[row][column] == WALL:
                return False
        return True

    def seen_from(self, lasers: tuple[Square, ...]) -> set[str]:
        """The letters of the places that at least one laser sees."""
        visible = _visible(self)
        return {name for laser in lasers for name in visible[laser]}

    def _squares(self) -> dict[Square, str]:
        return {(row, column): sign for row, line in enumerate(self.grid) for column, sign in enumerate(line)}


def naive_lasers(task: DevicesTask) -> tuple[Square, ...]:
    """A laser at every place: the naive answer."""
    return tuple(task.places.values())


@cache
def _visible(task: DevicesTask) -> dict[Square, frozenset[str]]:
    """Computes which squares are seen from each square of the floor."""
    places = task.places
    return {
        square: frozenset(name for name, place in places.items() if task.sees(square, place))
        for square in task.floor
    }


@cache
def fewest_lasers(task: DevicesTask) -> tuple[Square, ...]:
    """A plan than which none has fewer lasers."""
    places = list(task.places)
    columns = [
        frozenset(number for number, name in enumerate(places) if name in task.seen_from((square,)))
        for square in task.floor
    ]
    cover = minimum_cover(columns, len(places))
    assert cover.is_proved  # no deadline
    return tuple(task.floor[column] for column in cover.chosen)


def read_lasers(task: DevicesTask, answer: str) -> tuple[Square, ...]:
    """Reads ``ROW,COLUMN ROW,COLUMN``. Raises DevicePlanError."""
    words = answer.split()
    if not 0 < len(words) <= MAX_DEVICES:
        raise DevicePlanError(f"Write the places of 1 to {MAX_DEVICES} lasers, such as 1,4 6,2.")
    found = []
    for word in words:
        parts = word.split(",")
        if len(parts) != 2 or not all(part.isascii() and part.isdigit() and len(part) < 5 for part in parts):
            raise DevicePlanError(
                f"{word[:20]!r} is not a place: write its row, a comma and its column, counting from 0."
            )
        square = int(parts[0]), int(parts[1])
        if square not in task.floor:
            raise DevicePlanError(f"{word}: there is a wall, or nothing.")
        found.append(square)
    return tuple(found)


CHALLENGES_FILE: Final = "challenges.yaml"
PREFIX: Final = "challenge-"
"""Prefix of a challenge's subject in the journal."""
MOVES: Final = {"l": (0, -1), "r": (0, 1), "u": (-1, 0), "d": (1, 0)}
GOLD_RETURN, SILVER_RETURN = 0.98, 0.75
"""Shares of the greatest surplus over the shortest way that earn gold and silver."""
GOLD_STEPS, SILVER_STEPS = 0.35, 0.6
"""Shares of the budget of training steps likewise."""

POLL_S: Final = 0.1
"""Between two looks at the check of a program [s]."""

Cell: TypeAlias = tuple[int, int]


class ChallengeError(ValueError):
    """An answer cannot be judged; the message says why."""


@dataclass(frozen=True, slots=True)
class ExploitTask:
    """A reward on a grid that pays for something else than what is wanted."""

    grid: tuple[str, ...]
    """``#`` wall, ``S`` start, ``G`` target."""
    discount: float
    max_moves: int
    nearer: float
    """Paid for a move that shortens the way to the target."""
    farther: float
    """Paid for a move that lengthens it."""
    goal: float
    """Paid for arriving, which ends the episode."""


@dataclass(frozen=True, slots=True)
class LayersTask:
    """A layer case to plan."""

    file: Path


@dataclass(frozen=True, slots=True)
class TrainingTask:
    """A task to train within a budget."""

    trains: str
    max_steps: int
    success: float
    """Share of the test's episodes."""
    own_reward: bool


@dataclass(frozen=True, slots=True)
class RepairTask:
    """A program with faults, to be repaired against the clock."""

    folder: Path
    """The grader's assignment; its starter is what has the faults."""
    file: str
    gold_s: float
    silver_s: float
    """Seconds since the first look that earn gold and silver; later it is bronze."""


ChallengeTask: TypeAlias = ExploitTask | LayersTask | TrainingTask | RepairTask | DevicesTask


@dataclass(frozen=True, slots=True)
class Challenge:
    """One challenge."""

    id: str
    title: str
    story: str
    task_text: str
    lesson: str
    task: ChallengeTask


@dataclass(frozen=True, slots=True)
class AnswerComparison:
    """An answer beside others, all in one unit."""

    unit: str
    answer: float
    others: tuple[tuple[str, float], ...]
    """Name and figure of each: the naive answer and the best one, or what earns the medals."""
    more_is_better: bool = False


@dataclass(frozen=True, slots=True)
class Judgement:
    """The result of judging one answer."""

    medal: Medal
    text: str
    """One sentence."""
    comparison: AnswerComparison | None = None
    """None where an answer does not do what is asked, so that no figure can be compared."""


@cache
def all_challenges() -> tuple[Challenge, ...]:
    """Reads all challenges. Raises WorldError with all mistakes of the file."""
    file = lessons_folder() / CHALLENGES_FILE
    with open_document(file) as section:
        return tuple(_read_challenges(section, file.parent))


def find_challenge(name: str) -> Challenge:
    """Finds a challenge by its id. Raises LookupError that offers the nearest one."""
    known = {each.id: each for each in all_challenges()}
    if name not in known:
        raise LookupError(f"There is no challenge {quoted(name)}: {suggestion(name, tuple(known))}.")
    return known[name]


def _say_nothing(_: str) -> None:
    """Shows no progress."""


def judge(
    challenge: Challenge,
    answer: str,
    runs: Path,
    seconds: float = math.inf,
    show_progress: Callable[[str], None] = _say_nothing,
) -> Judgement:
    """Judges an answer: moves, places, the path of a plan or of a repaired file, or the name of a training run in ``runs``.

    ``seconds``: since the first look at the challenge. ``show_progress``: called a few times a second while a program is
    checked, with what is being done; what it raises ends the check. Raises ChallengeError and WorldError.
    """
    match challenge.task:
        case ExploitTask():
            return _judge_moves(challenge.task, answer)
        case LayersTask():
            return _judge_plan(challenge.task, Path(answer))
        case TrainingTask():
            return _judge_run(challenge.task, runs, answer)
        case DevicesTask():
            return _judge_devices(challenge.task, answer)
        case RepairTask():
            return _judge_repair(challenge.task, Path(answer), seconds, show_progress)


def record_judgement(journal: ProgressJournal, challenge: Challenge, judgement: Judgement) -> None:
    """Records a medal. Raises ProgressError."""
    journal.add(
        EventKind.FINISH,
        f"{PREFIX}{challenge.id}",
        {"medal": judgement.medal.value, "text": judgement.text},
    )


def challenge_medals(events: list[ProgressEvent]) -> dict[str, Medal]:
    """The best medal of each challenge that has one, by its id."""
    best: dict[str, Medal] = {}
    for event in events:
        medal = int(event.number("medal") or 0)
        if event.kind is EventKind.FINISH and event.subject.startswith(PREFIX) and medal in tuple(Medal):
            name = event.subject.removeprefix(PREFIX)
            best[name] = max(best.get(name, Medal.NONE), Medal(medal))
    return best


def game_summary(events: list[ProgressEvent], lessons: Collection[str] = ()) -> GameSummary:
    """All that was won. ``lessons``: as of ``level_progress``. Raises WorldError and FileNotFoundError."""
    medals = challenge_medals(events)
    best = tuple(medals.get(each.id, Medal.NONE) for each in all_challenges())
    return GameSummary(level_progress(all_levels(), events, lessons), best)


# Break a reward


def shortest_moves(task: ExploitTask) -> str:
    """The moves of a shortest way to the target: the naive answer."""
    distances, cell, moves = _distances(task), _find(task, "S"), ""
    while distances[cell]:
        moves += next(name for name in MOVES if distances.get(_step(cell, name), math.inf) < distances[cell])
        cell = _step(cell, moves[-1])
    return moves


def paid_for(task: ExploitTask, moves: str) -> tuple[float, bool]:
    """The discounted sum that moves are paid, and whether they reach the target. A move into a wall stays."""
    distances, cell, total = _distances(task), _find(task, "S"), 0.0
    for number, name in enumerate(moves):
        following = _step(cell, name)
        following = following if following in distances else cell
        total += task.discount**number * _pay(task, distances, cell, following)
        cell = following
        if not distances[cell]:
            return total, True
    return total, False


def best_moves(task: ExploitTask) -> str:
    """Moves that are paid most of all that never reach the target, by dynamic programming."""
    distances = _distances(task)
    cells = [cell for cell, distance in distances.items() if distance]
    value = dict.fromkeys(cells, 0.0)
    choices: list[dict[Cell, str]] = []
    for _ in range(task.max_moves):
        chosen, better = {}, {}
        for cell in cells:
            ways = []
            for name in MOVES:
                following = _step(cell, name)
                following = following if following in distances else cell
                if distances[following]:
                    pay = _pay(task, distances, cell, following)
                    ways.append((pay + task.discount * value[following], name))
            better[cell], chosen[cell] = max(ways)
        value = better
        choices.append(chosen)
    cell, moves = _find(task, "S"), ""
    for chosen in reversed(choices):
        moves += chosen[cell]
        following = _step(cell, moves[-1])
        cell = following if following in distances else cell
    return moves


def _judge_moves(task: ExploitTask, answer: str) -> Judgement:
    moves = "".join(answer.split()).lower()
    if strange := sorted(set(moves) - set(MOVES)):
        raise ChallengeError(f"{quoted(strange[0])} is not a move: write l, r, u and d.")
    if len(moves) > task.max_moves:
        raise ChallengeError(f"{len(moves)} moves are too many; an episode has {task.max_moves}.")
    honest, _ = paid_for(task, shortest_moves(task))
    most, _ = paid_for(task, best_moves(task))
    paid, reaches = paid_for(task, moves)
    comparison = AnswerComparison(
        "paid", paid, (("naive answer", honest), ("best answer", most)), more_is_better=True
    )
    if reaches:
        return Judgement(
            Medal.NONE, f"It is paid {paid:.2f} and reaches the target: that is what was wanted."
        )
    if paid <= honest:
        return Judgement(
            Medal.NONE, f"It is paid {paid:.2f}; the shortest way is paid {honest:.2f}.", comparison
        )
    share = (paid - honest) / (most - honest)
    medal = Medal.GOLD if share >= GOLD_RETURN else Medal.SILVER if share >= SILVER_RETURN else Medal.BRONZE
    return Judgement(
        medal, f"It is paid {paid:.2f}, the shortest way only {honest:.2f}: the reward is broken.", comparison
    )


def _pay(task: ExploitTask, distances: dict[Cell, int], cell: Cell, following: Cell) -> float:
    change = distances[cell] - distances[following]
    pay = task.nearer if change > 0 else task.farther if change < 0 else 0.0
    return pay + (task.goal if not distances[following] else 0.0)


def _distances(task: ExploitTask) -> dict[Cell, int]:
    """The number of moves from every free cell to the target."""
    goal = _find(task, "G")
    found, waiting = {goal: 0}, deque([goal])
    while waiting:
        cell = waiting.popleft()
        for name in MOVES:
            row, column = _step(cell, name)
            if task.grid[row][column] != "#" and (row, column) not in found:
                found[row, column] = found[cell] + 1
                waiting.append((row, column))
    return found


def _find(task: ExploitTask, sign: str) -> Cell:
    return next((row, line.index(sign)) for row, line in enumerate(task.grid) if sign in line)


def _step(cell: Cell, name: str) -> Cell:
    return cell[0] + MOVES[name][0], cell[1] + MOVES[name][1]


# Beat a layer plan


def naive_plan(case: LayerCase) -> LayerAssignment:
    """A layer of its own for every requirement: the naive answer."""
    layers: list[NamedLayer] = []
    watches: dict[str, list[str]] = {}
    for number, contact in enumerate(sorted(case.collide, key=str), 1):
        layers.append(NamedLayer(f"layer {number}", frozenset((contact.a, contact.b))))
    for laser in case.lasers:
        for entity in sorted(laser.sees):
            layers.append(NamedLayer(f"{laser.name} sees {entity}", frozenset((entity,))))
            watches.setdefault(laser.name, []).append(layers[-1].name)
    return LayerAssignment(tuple(layers), {laser: tuple(names) for laser, names in watches.items()})


def judge_assignment(task: LayersTask, plan: LayerAssignment) -> Judgement:
    """Judges a plan by its breaches, and by its layers against the fewest and the naive plan's."""
    case = read_requirements(task.file).case
    breaches = find_breaches(case, plan)
    if breaches:
        return Judgement(Medal.NONE, f"It does not do what is asked: {breaches[0]}.")
    count, naive = len(plan.layers), len(naive_plan(case).layers)
    fewest = len(solve_layers(case).assignment.layers)
    text = f"{count} layers; a layer for every line takes {naive}, and {fewest} are enough."
    return _judge_count("layers", text, count, fewest, naive)


def _judge_count(unit: str, text: str, count: int, fewest: int, naive: int) -> Judgement:
    """Judges an answer of which less is better and ``fewest`` is proved."""
    comparison = AnswerComparison(unit, count, (("naive answer", naive), ("best answer", fewest)))
    if count >= naive:
        return Judgement(Medal.NONE, text, comparison)
    medal = Medal.GOLD if count <= fewest else Medal.SILVER if count == fewest + 1 else Medal.BRONZE
    return Judgement(medal, text, comparison)


def _judge_plan(task: LayersTask, file: Path) -> Judgement:
    if not file.is_file():
        raise ChallengeError(f"{file}: there is no such file.")
    with open_document(file.absolute(), is_partial=True) as section:
        layers = section.section("layers")
        lasers = None if section.is_blank("lasers") else section.section("lasers")
        named = tuple(NamedLayer(name, frozenset(layers.texts(name))) for name in sorted(layers.keys()))
        watches = {} if lasers is None else {name: lasers.texts(name) for name in sorted(lasers.keys())}
    return judge_assignment(task, LayerAssignment(named, watches))


# Train within a budget


def _judge_run(task: TrainingTask, runs: Path, name: str) -> Judgement:
    from kit.learning.training.run_text import success_shares
    from kit.learning.training.runs import RunError, find_run

    try:
        run = find_run(runs, name)
        config, summary = run.config(), run.summary()
    except (RunError, LookupError) as error:
        raise ChallengeError(str(error)) from None
    trained = json.dumps(config.choice.as_dict())
    if f'"{task.trains}"' not in trained:
        raise ChallengeError(f"{name} trains another task than {task.trains}.")
    best = summary.best_evaluation
    shares = [] if best is None else list(success_shares(best).values())
    success = sum(shares) / len(shares) if shares else 0.0
    return judge_training(task, summary.steps, success, has_own_reward=config.reward_file is not None)


def judge_training(task: TrainingTask, steps: int, success: float, *, has_own_reward: bool) -> Judgement:
    """Judges a training by its steps, its test's successes (0 to 1) and its reward."""
    text = f"{success:.0%} successes after {steps:,} steps."
    if task.own_reward and not has_own_reward:
        return Judgement(Medal.NONE, f"{text} The reward was the kit's: --reward FILE trains with yours.")
    others = (("budget", task.max_steps), ("gold at", int(GOLD_STEPS * task.max_steps)))
    comparison = AnswerComparison("steps", steps, others)
    if success < task.success or steps > task.max_steps:
        text = f"{text} {task.success:.0%} in at most {task.max_steps:,} are asked for."
        return Judgement(Medal.NONE, text, comparison)
    share = steps / task.max_steps
    medal = Medal.GOLD if share <= GOLD_STEPS else Medal.SILVER if share <= SILVER_STEPS else Medal.BRONZE
    return Judgement(medal, text, comparison)


# Mount the fewest lasers


def _judge_devices(task: DevicesTask, answer: str) -> Judgement:
    """Judges by what is not seen, then by the number of lasers against the fewest and the naive plan's."""
    try:
        lasers = read_lasers(task, answer)
    except DevicePlanError as error:
        raise ChallengeError(str(error)) from None
    missed = sorted(set(task.places) - task.seen_from(lasers))
    if missed:
        return Judgement(Medal.NONE, f"Nothing sees {', '.join(missed)}.")
    count, fewest, naive = len(lasers), len(fewest_lasers(task)), len(naive_lasers(task))
    text = f"{count} lasers; one at every place takes {naive}, and {fewest} are enough."
    return _judge_count("lasers", text, count, fewest, naive)


# Repair a program against the clock


def _judge_repair(
    task: RepairTask, file: Path, seconds: float, show_progress: Callable[[str], None]
) -> Judgement:
    if not file.is_file() or file.name != task.file:
        raise ChallengeError(f"Hand in the repaired {task.file}; {file} is not it.")
    exercise = Exercise(task.folder.name, task.folder, task.file, seconds=60.0)
    with ExerciseCheck(exercise, file) as check:
        while (report := check.poll()) is None:
            show_progress(check.progress)
            time.sleep(POLL_S)
    if report.result is None:
        raise ChallengeError(report.problem)
    if report.lost_criteria:
        lost = report.lost_criteria[0]
        return Judgement(Medal.NONE, f"Not repaired yet: {lost.rationale or lost.title}")
    text = f"Repaired after {seconds:.0f} s; gold is at {task.gold_s:.0f} s, silver at {task.silver_s:.0f} s."
    comparison = AnswerComparison("s", seconds, (("gold at", task.gold_s), ("silver at", task.silver_s)))
    medal = (
        Medal.GOLD if seconds <= task.gold_s else Medal.SILVER if seconds <= task.silver_s else Medal.BRONZE
    )
    return Judgement(medal, text, comparison)


# The file


def _read_challenges(section: Section, folder: Path) -> Iterator[Challenge]:
    for each in section.sections("challenges", at_least=1):
        yield Challenge(
            each.name("id"),
            each.name("title"),
            each.text("story"),
            each.text("task"),
            each.name("lesson"),
            _read_task(each, folder),
        )
        each.finish()


def _read_task(each: Section, folder: Path) -> ChallengeTask:
    match each.text("kind", choices=("exploit", "layers", "training", "repair", "devices")):
        case "exploit":
            return ExploitTask(
                each.texts("map", at_least=1),
                each.number("discount", above=0, maximum=1),
                each.integer("max_moves", minimum=1, maximum=1000),
                each.number("nearer"),
                each.number("farther"),
                each.number("goal"),
            )
        case "layers":
            return LayersTask(folder / each.text("case"))
        case "devices":
            return DevicesTask(each.texts("map", at_least=1))
        case "repair":
            return RepairTask(
                folder / each.text("exercise"),
                each.name("file"),
                each.number("gold_seconds", above=0),
                each.number("silver_seconds", above=0),
            )
        case _:
            return TrainingTask(
                each.name("trains"),
                each.integer("max_steps", minimum=1, maximum=10**9),
                each.number("success", above=0, maximum=1),
                each.flag("own_reward"),
            )

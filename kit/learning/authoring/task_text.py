"""A task in words and as a picture: what the agent sees and does, what a step earns, how episodes start and end."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from kit.document.blocks import Block, CellStyle, Column, Table, Text, Tone, ToneText, labelled_table
from kit.geometry import Pose
from kit.learning.environment.batch import BatchEnv
from kit.learning.maps.batch_floor import hull_radius, hull_width, measure_floor
from kit.learning.maps.batch_map import load_batch_map
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.catalogue import tasks_folder
from kit.learning.tasks.curriculum import practices
from kit.learning.tasks.goals.registry import goal_kinds
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.observations import PART_NAMES, ObservationSpec
from kit.learning.tasks.reward import TermWeight
from kit.learning.tasks.reward_terms import TERMS, term_settings
from kit.learning.tasks.task_case import EpisodePlaces, TaskCase
from kit.learning.tasks.transition import TRANSITION_FIELDS, Transition
from kit.plain_text import counted, join_names
from kit.render.scene import Disc, Scene, SceneMark
from kit.world.catalogue import MapCard

SAMPLED_WORLDS, SAMPLED_STEPS = 60, 60
"""The average step is measured over this many worlds and steps of each."""
DRAWN_PLACES = 40
"""Number of evenly spread places drawn for an area."""


SHAPE = re.compile(r"^\(\.\.\.(, R)?(, \d+)?\):? ?")
"""Start of the description of a transition's field: its shape for many worlds."""


def tasks_table(tasks: Iterable[LearningTask], title: str = "", *, indent: int = 0) -> Table:
    """The tasks there are: a name, and what is learned."""
    rows = ((ToneText(task.name, Tone.BOLD), task.summary) for task in tasks)
    return labelled_table(rows, title, indent=indent)


def task_blocks(task: LearningTask) -> list[Block]:
    """What ``kit task show`` prints below the maps."""
    kind = "one of the kit's tasks" if task.file is None or not task.version else f"version {task.version}"
    cases = task.map_cases()
    where = join_names(task.maps) if task.maps else str(task.map_cards[0].world_file)
    about = [
        ("file", f"{task.file} ({kind})"),
        ("on", f"{where}; {counted(len(cases), 'case')}, {_robots_text(task)}"),
        ("goal", task.goal.description),
        *_titled_rows("ends", _ending_lines(task)),
        *_titled_rows("learns", _curriculum_lines(task)),
        *_titled_rows("differs", _randomness_lines(task)),
    ]
    return [
        Text(f"{task.name}: {task.summary}" if task.summary else task.name),
        replace(labelled_table(about), is_tight=True),
        *_observation_blocks(task.observation),
        *_action_blocks(task),
        *_reward_blocks(task),
    ]


def reward_blocks(task: LearningTask) -> list[Block]:
    """What a step earns in few words: each term with its weight, and what it says of itself."""
    if task.reward_file is not None:
        return [Text(f"what reward() in {task.reward_file} returns", lead="earns")]
    reward = task.reward
    scale = "" if reward.scale == 1.0 else f", times {reward.scale:g}"
    rows = [
        (f"{weight.value:g}", f"{weight.term}{_settings_text(weight)}", term_summary(weight.term))
        for weight in reward.weights
    ]
    return [
        Text(f"the sum of these terms{scale}:", lead="earns"),
        labelled_table(rows, indent=2, is_tight=True),
    ]


def key_tables() -> list[Table]:
    """What ``kit task keys`` prints: what a task file, the terms of its reward and a reward of one's own may name."""
    written = (tasks_folder() / "README.md").read_text(encoding="utf-8").replace("`", "")
    keys = [
        (key, text)
        for key, text in re.findall(r"^\| (\S+) \| (.+) \|$", written, re.MULTILINE)
        if key != "Key"
    ]
    cases = " ".join(written[written.index("A case has") :].split())
    terms = [(f"{term}{_usual_settings(term)}", term_summary(term)) for term in TERMS]
    goals = [
        (f"{kind} {goal.usual_settings()}".rstrip(), (inspect.getdoc(goal) or "").partition("\n")[0])
        for kind, goal in goal_kinds().items()
    ]
    asked = _transition_docs()
    facts = [(name, SHAPE.sub("", asked[name])) for name in TRANSITION_FIELDS]
    facts_title = (
        "What reward() in a Python file may ask for, in metres and radians; of several robots a list:"
    )
    return [
        labelled_table(keys, "Keys of a task file:", indent=2),
        labelled_table(goals, "Kinds of goal, with their settings:", indent=2),
        labelled_table(terms, "Terms that reward: {terms: ...} weighs, with their settings:", indent=2),
        labelled_table(facts, facts_title, indent=2),
        labelled_table([(cases,)], "Cases:", indent=2),
    ]


def fields_table() -> Table:
    """What the record that a reward from Python gets tells, field by field: its shape for n worlds, and its meaning."""
    asked = _transition_docs()
    rows = []
    for name in TRANSITION_FIELDS:
        shape = SHAPE.match(asked[name])
        axes = "" if shape is None else shape[0].strip().replace("...", "n").replace("(n)", "(n,)")
        rows.append((name, axes, SHAPE.sub("", asked[name])))
    columns = tuple(Column(title, CellStyle.TEXT) for title in ("Field", "Shape", "Meaning"))
    return Table("reward-fields", "", columns, tuple(rows))


def _usual_settings(term: str) -> str:
    return "".join(f" {name} {value:g}" for name, value in term_settings(term).items())


def _transition_docs() -> dict[str, str]:
    """What stands below each field and in each property of ``Transition``."""
    body = ast.parse(inspect.getsource(Transition)).body[0].body  # type: ignore[attr-defined]  # a class
    found = {each.name: ast.get_docstring(each) or "" for each in body if isinstance(each, ast.FunctionDef)}
    for field, text in zip(body, [*body[1:], None], strict=True):
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name):
            is_text = isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
            found[field.target.id] = str(text.value.value) if is_text else ""
    return {name: " ".join(text.replace("``", "").split()) for name, text in found.items()}


def _titled_rows(title: str, lines: Iterator[str]) -> Iterator[tuple[str, str]]:
    """The rows of a table, whose title stands beside the first."""
    for number, line in enumerate(lines):
        yield "" if number else title, line


def _robots_text(task: LearningTask) -> str:
    return "one robot" if task.robots == 1 else f"{task.robots} robots driven by one agent"


def _observation_blocks(seen: ObservationSpec) -> Iterator[Block]:
    frames = f" ({seen.frames} frames of {seen.frame_size})" if seen.frames > 1 else ""
    yield Text(f"{seen.size} numbers{frames} per robot:", lead="sees")
    limit = f"at most {seen.clip:g} m, times {seen.scale:g}"
    parts = [f"{part.name}: {PART_NAMES[part.name]}" for part in seen.parts]
    if seen.sectors:
        parts.insert(0, f"the shortest range of each of {seen.sector_count} sectors, {limit}")
    if seen.side_rays:
        parts.insert(0, f"2 rays towards the other robot, {limit}")
    if seen.rays:
        others = ", others for the second robot on" if seen.other_rays else ""
        parts.insert(0, f"{counted(len(seen.rays), 'ray')}{others}, {limit}")
    yield from (Text(part, indent=2, hang=2, is_tight=True) for part in parts)


def _action_blocks(task: LearningTask) -> Iterator[Block]:
    actions = task.actions
    checks = "" if task.collision_checks == 1 else f", {task.collision_checks} collision checks"
    stops = ", then stopped until the next command" if task.stops_between else ""
    time = f"for {task.step_time:g} s{checks}{stops}"
    card, _ = task.map_cases()[0]
    is_tricycle = load_batch_map(card, task.robots_on(card)).robot.wheelbase > 0.0
    turn, unit = ("angle of the front wheel", "rad") if is_tricycle else ("turn", "rad/s")
    if not isinstance(actions, DiscreteActions):
        (slow, fast), (right, left) = actions.linear, actions.angular
        speeds = f"any speed from {slow:g} to {fast:g} m/s and {turn} from {right:g} to {left:g} {unit}"
        yield Text(f"{speeds}, {time}", lead="does")
        return
    yield Text(f"one of {len(actions.names)} twists, {time}:", lead="does")
    columns = (Column("", CellStyle.TEXT), Column("m/s"), Column(unit))
    rows = tuple((name, *twist) for name, twist in zip(actions.names, actions.twist_table, strict=True))
    yield Table("actions", "", columns, rows, is_ruled=False, indent=2, is_tight=True)


def _reward_blocks(task: LearningTask) -> Iterator[Block]:
    if task.reward_file is not None:
        yield Text(f"what reward() in {task.reward_file} returns", lead="earns")
        return
    reward = task.reward
    scale = "" if reward.scale == 1.0 else f", times {reward.scale:g}"
    yield Text(f"the sum of these terms{scale}; of each its mean per step for random actions:", lead="earns")
    average = average_step(task)
    columns = (
        Column("weight"),
        Column("term", CellStyle.TEXT),
        Column("mean", decimals=4),
        Column("", CellStyle.TEXT),
    )
    rows = tuple(
        (
            f"{weight.value:g}",
            f"{weight.term}{_settings_text(weight)}",
            average[weight.term],
            term_summary(weight.term),
        )
        for weight in reward.weights
    )
    total = sum(average.values()) * reward.scale
    note = f"total {total:.4g} per step"
    yield Table("reward", "", columns, rows, note, is_ruled=False, indent=2, is_tight=True)


def _curriculum_lines(task: LearningTask) -> Iterator[str]:
    cases = [(case.name, case.group) for _, case in task.map_cases()]
    stages = practices(task.curriculum, cases)
    for number, stage in enumerate(stages, 1):
        yield f"{number}. {', '.join(stage.cases)}, until each has a success rate of {stage.success:g}"
    if stages:
        yield f"{len(stages) + 1}. all cases"


def _settings_text(weight: TermWeight) -> str:
    settings = ", ".join(f"{name} {value:g}" for name, value in weight.settings)
    return f" ({settings})" if settings else ""


def term_summary(term: str) -> str:
    """The first sentence of what a reward term says of itself."""
    text = (inspect.getdoc(TERMS[term]) or "").replace("``", "")
    return text.partition(".")[0].partition("\n")[0]


def average_step(task: LearningTask) -> dict[str, float]:
    """What a step of a robot that acts at random earns on average, by term, before the reward's scale."""
    chance = np.random.default_rng(0)
    batch = BatchEnv(replace(task, collision_ending="continues"), SAMPLED_WORLDS, seed=0)
    batch.reset()
    space = batch.action_space
    space.seed(int(chance.integers(2**31)))
    sums: dict[str, float] = {}
    for _ in range(SAMPLED_STEPS):
        step = batch.step(np.stack([space.sample() for _ in range(batch.n)]))
        for name, value in step.terms.items():
            sums[name] = sums.get(name, 0.0) + float(value.mean())
    return {name: value / SAMPLED_STEPS / task.reward.scale for name, value in sums.items()}


def _ending_lines(task: LearningTask) -> Iterator[str]:
    time = "terminated" if task.timeout_terminal else "truncated"
    yield f"goal reached: {task.goal_ending}"
    yield f"collision: {task.collision_ending}"
    yield f"after {task.max_steps} steps ({task.max_steps * task.step_time:g} s): {time}"
    if task.goal.has_standing_targets:
        measured = "hull" if task.measured_to == "hull" else "axle's middle"
        yield f"the target is reached within {task.target_radius:g} m of the {measured}"


def _randomness_lines(task: LearningTask) -> Iterator[str]:
    start = task.start
    if start.noise or start.max_rotation:
        yield f"starts by up to {start.noise:g} m and {start.max_rotation:g} rad"
    if task.disturbances:
        yield str(task.disturbances)


def describe_case(task: LearningTask, case: TaskCase) -> str:
    """One line: where its episodes start and end."""
    starts = " and ".join(places.description for places in case.starts[: task.robots])
    target = f" to {case.targets.description}" if task.goal.needs_target else ""
    return f"{case.name}: from {starts}{target}"


def build_case_scene(task: LearningTask, card: MapCard, case: TaskCase) -> Scene:
    """The map of a case with its starts (S) and targets."""
    batch_map = load_batch_map(card, task.robots_on(card))
    radius = hull_radius(batch_map)

    def drawn(places: EpisodePlaces) -> list[Pose]:
        if not places.is_area:
            return list(places.poses)
        floor = measure_floor(batch_map)
        cells = floor.area_cells(places.area, floor.clearance > radius)
        chosen = cells[np.linspace(0, len(cells) - 1, min(DRAWN_PLACES, len(cells))).astype(int)]
        return [Pose(x, y) for x, y in chosen.tolist()]

    starts = [pose for places in case.starts[: task.robots] for pose in drawn(places)]
    targets = drawn(case.targets) if task.goal.needs_target else []
    return Scene(
        walls=batch_map.walls,
        targets=tuple(Disc(pose.x, pose.y, task.target_radius) for pose in targets),
        marks=tuple(SceneMark(pose.x, pose.y, "S") for pose in starts),
        passage=hull_width(batch_map),
    )

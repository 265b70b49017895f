"""Writes new task files: after a task of the kit's, on a map of the kit's, or for a world of one's own."""

from __future__ import annotations

import math
import re
from pathlib import Path

from kit.geometry import Pose
from kit.learning.maps.batch_floor import hull_radius, hull_width, measure_floor
from kit.learning.maps.batch_map import DRIVES, BatchMap, load_batch_map
from kit.learning.tasks.catalogue import task_names, tasks_folder
from kit.learning.tasks.goals.registry import goal_kinds
from kit.learning.tasks.goals.target import REACH_TARGET
from kit.learning.tasks.task_reader import TASK_FILE
from kit.plain_text import quoted
from kit.sim.simulation import load_world
from kit.world.catalogue import (
    WORLD_FILE,
    MapCard,
    allowed_root_of,
    find_map,
    map_names,
    own_card,
    own_map_folder,
)

NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,59}")
TWO_WHEELS = """\
  twists:                     # m/s forward, rad/s to the left; or linear: [0, 0.4] and angular: [-1.5, 1.5]
    forward: [{fast:g}, 0]
    left: [0, {turn:g}]
    right: [0, -{turn:g}]
    forward_left: [{slow:g}, {turn:g}]
    forward_right: [{slow:g}, -{turn:g}]
"""
TRICYCLE = """\
  twists:                     # m/s of the front wheel, its angle in rad to the left; or linear and angular: [least, greatest]
    forward: [{fast:g}, 0]
    forward_left: [{fast:g}, {turn:g}]
    forward_right: [{fast:g}, -{turn:g}]
    back: [-{fast:g}, 0]
    back_left: [-{fast:g}, {turn:g}]
    back_right: [-{fast:g}, -{turn:g}]
"""
STANDARD = """\
observation:
  sectors: 13                 # the shortest range of each
  target: true                # distance and direction of the target
  scale: 0.5                  # multiplies ranges and distances
reward:
  terms:                      # `kit task keys` names them all
    progress: 1.0             # metres on the way to the target; for other goals: achieving
    elapsed: -0.01
    collided: -2.0
    reached: 2.0
goal: {{kind: {goal}}}          # or {other_goals}
target: {{radius: {radius:g}}}
step: {{time: 0.2, collision_checks: 2, limit: 400}}
start: {{noise: 0.05, max_rotation: 0.3}}
endings: {{collision: terminated, time: truncated}}
preset: hallway               # the kit's settings for learning
success: 0.95                 # training ends when this many episodes of every case surely succeed
"""


class NewTaskError(Exception):
    """A task cannot be made; the message says why and what to do."""


def new_task_file(name: str, source: str, folder: Path) -> Path:
    """Writes a task's file and returns it: ``folder/NAME/task.yaml``, or ``NAME.yaml`` beside a world: in the folder
    ``source``, or in the workspace's map of that name.

    NewTaskError if the name is taken or nothing is known by ``source``; UnsupportedWorld; WorldError.
    """
    path = Path(source)
    if not path.exists():
        path = own_map_folder(source) or path
    if source in task_names():
        return write_task(name, (tasks_folder() / f"{source}.yaml").read_text(), folder / name / TASK_FILE)
    if source in map_names():
        return write_task(name, _map_text(find_map(source)), folder / name / TASK_FILE)
    if (path / WORLD_FILE).is_file():
        return write_task(name, _world_text(path / WORLD_FILE), path / f"{name}.yaml")
    raise NewTaskError(
        f"{quoted(source)} is not one of the kit's tasks or maps, nor a map of yours, nor a folder with a {WORLD_FILE}. "
        "`kit task list` and `kit maps` list them."
    )


def write_task(name: str, text: str, file: Path) -> Path:
    """Writes the new file of a task of this name, and returns it. NewTaskError if the name cannot be one, or is taken."""
    if not NAME_PATTERN.fullmatch(name):
        raise NewTaskError(f"{quoted(name)}: a task's name may contain letters, digits, '_' and '-'.")
    if file.exists():
        raise NewTaskError(f"{file} already exists: choose another name.")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return file


def _map_text(card: MapCard) -> str:
    cases = "".join(
        f"#   - {{name: {case.name}, start: [{case.start.x:g}, {case.start.y:g}, {case.start.theta:g}], "
        f"target: [{case.target[0]:g}, {case.target[1]:g}]}}\n"
        for case in card.cases
        if case.partner_start is None
    )
    own = "# Without its own cases, a task has those of its maps:\n# cases:\n" + cases if cases else ""
    return f"summary: Drive to the target on {card.name}\nmaps: [{card.name}]\n{own}{_standard_text(load_batch_map(card))}"


def _standard_text(batch_map: BatchMap) -> str:
    """What every new task begins with, with actions that the robot's motors can do."""
    robot = batch_map.robot
    twists = (TRICYCLE if robot.wheelbase else TWO_WHEELS).format(
        fast=min(0.4, robot.max_speed),
        slow=min(0.3, robot.max_speed),
        turn=min(0.9 if robot.wheelbase else 1.2, robot.max_turn_rate),
    )
    return f"actions:\n{twists}" + STANDARD.format(
        goal=REACH_TARGET.kind,
        other_goals=", ".join(kind for kind in goal_kinds() if kind != REACH_TARGET.kind),
        radius=0.2 if len(batch_map.starts) == 1 else 0.4,
    )


def _world_text(world_file: Path) -> str:
    """A task with the starts and targets of the map's card; without one, from the robot's place in the world to the
    farthest place that it can reach."""
    known = own_card(world_file)
    if known is not None:
        cases = "".join(
            f"  - name: {case.name}\n    start: [{case.start.x:g}, {case.start.y:g}, {case.start.theta:g}]\n"
            + (f"    other_starts: [{_pose_text(case.partner_start)}]\n" if case.partner_start else "")
            + f"    target: [{case.target[0]:g}, {case.target[1]:g}]\n"
            for case in known.cases
        )
        return _own_world_text(world_file, load_batch_map(known), cases)
    world = load_world(world_file, root=allowed_root_of(world_file))
    robots = [
        model.name
        for model in world.models
        if any(isinstance(plugin.params, DRIVES) for plugin in model.plugins)
    ]
    if not robots:
        raise NewTaskError(
            f"{world_file}: no model in it has a DiffDrive or a TricycleDrive, so there is nothing to train."
        )
    folder = world_file.parent
    card = MapCard(
        folder.name,
        folder.name,
        "",
        "",
        folder,
        world_file,
        robots[0],
        None,
        (),
        allowed_root_of(world_file) or folder,
    )
    batch_map = load_batch_map(card, (robots[0],))
    start = batch_map.starts[0]
    x, y = _farthest_place(batch_map)
    case = f"  - name: there\n    start: [{start.x:g}, {start.y:g}, {start.theta:g}]\n    target: [{x:.2f}, {y:.2f}]\n"
    return _own_world_text(world_file, batch_map, case)


def _pose_text(pose: Pose) -> str:
    return f"[{pose.x:g}, {pose.y:g}, {pose.theta:g}]"


def _own_world_text(world_file: Path, batch_map: BatchMap, cases: str) -> str:
    names = ", ".join(batch_map.robot_names)
    robots = names if len(batch_map.robot_names) == 1 else f"[{names}]"
    return (
        f"summary: Drive to the target\nworld: {world_file.name}\nrobots: {robots}\ncases:\n{cases}"
        f"{_standard_text(batch_map)}"
    )


def _farthest_place(batch_map: BatchMap) -> tuple[float, float]:
    floor, start = measure_floor(batch_map), batch_map.starts[0]
    reached = floor.reached_from(start.x, start.y, hull_width(batch_map))
    cells = floor.area_cells(None, reached & (floor.clearance > hull_radius(batch_map)))
    if not len(cells):
        raise NewTaskError(
            f"{batch_map.name}: the robot touches a wall at its start: move it in the world first."
        )
    x, y = max(cells.tolist(), key=lambda cell: math.hypot(cell[0] - start.x, cell[1] - start.y))
    return x, y

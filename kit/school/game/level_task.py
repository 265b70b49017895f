"""Tasks from levels of the game: what an agent learns a level by, with what the level has of its own: ice, carts, a battery.

What such an agent sees and earns was measured: of each task's by `python -m tests.school.game.measured_drivers` one has a medal.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields
from types import MappingProxyType
from typing import Final

from kit.geometry import Pose
from kit.learning.maps.batch_map import load_batch_map
from kit.learning.tasks.goals.goal import CaseTargets
from kit.school.game.levels import SPEED, TURN_RATE, GameLevel
from kit.school.game.race import DOCK_RADIUS, DOCK_TIME
from kit.school.game.references import reference_seconds

STEP_S: Final = 0.2
MAX_STEPS: Final = 400
LONGEST: Final = 2.2
"""So many times as long as the reference drive an episode may take."""
PAIR_TURN: Final = 1.0
"""Of each of two robots [rad/s]."""
STAY_S, AT_DOCK_M = DOCK_TIME + STEP_S, 0.8 * DOCK_RADIUS
"""For so long, a step longer than a battery needs, a robot stands so near a dock."""
TWO_WHEELS: Final = ("forward", "back", "left", "right", "forward_left", "forward_right")
TRICYCLE: Final = ("forward", "back", "back_left", "back_right", "forward_left", "forward_right")
PAIR: Final = ("stop", "forward", "back", "forward_left", "forward_right", "left", "right")
SEEN: Final = MappingProxyType(
    {
        CaseTargets.NONE: "own_pose: true, achieved: true",
        CaseTargets.PLACE: "target: true",
        CaseTargets.ROUTE: "target: true",
        CaseTargets.LEADER: "target: true, speeds: true, frames: 4",
    }
)
"""What the agent sees beside its scan, by what the goal takes targets for."""
EARNED: Final = MappingProxyType(
    {
        CaseTargets.NONE: "achieving: 12.0, elapsed: -0.02, collided: -1.0, reached: 4.0",
        CaseTargets.PLACE: "progress: 1.0, elapsed: -0.01, collided: -2.0, reached: 2.0",
        CaseTargets.ROUTE: "progress: 1.0, achieving: 4.0, elapsed: -0.01, collided: -2.0, reached: 2.0",
        CaseTargets.LEADER: "achieving: 10.0, elapsed: -0.03, off_leader: -0.02, collided: -2.0, reached: 2.0",
    }
)


MEMORY: Final = "recurrent-ppo"
"""The algorithm for agents that must remember."""
SEED: Final = 1
"""Of the training that was measured; where an agent must remember the rooms between docks, not every seed learns it."""
EARNED_BY_DOCKS: Final = "progress: 1.0, achieving: 10.0, elapsed: -0.01, collided: -1.0, reached: 2.0"


def needs_memory(level: GameLevel) -> bool:
    """Whether an agent must remember: the way it has come, where odometry lies; the rooms it has been in, between docks."""
    return bool(level.conditions.wheel_error or (level.conditions.charge and level.targets))


def memory_steps(level: GameLevel) -> int | None:
    """The steps that a training with memory needs; None: as many as its preset has."""
    return 1_500_000 if level.conditions.charge else None


def task_text(level: GameLevel) -> str:
    """The text of a task's file for a level. Raises WorldError where the level's world is wrong."""
    return "\n".join(_lines(level)) + "\n"


def _lines(level: GameLevel) -> Iterator[str]:
    conditions, scenario, goal = level.conditions, level.find_scenario(), level.goal
    case, starts = scenario.case, scenario.starts
    assert case is not None  # every level has one
    yield f"summary: The level {level.title}"
    yield f"maps: [{level.map_name}]"
    if conditions.carts:
        yield "carts:"
    for cart in conditions.carts:
        way = f"delta: [{cart.delta.x:g}, {cart.delta.y:g}], duration: {cart.duration:g}"
        yield f"  - {{name: {cart.name}, start: {_pose(cart.start)}, {way}}}"
    start = f"start: {_pose(starts[0])}"
    if len(starts) > 1:
        start += f", other_starts: [{_pose(starts[1])}]"
    targets = _targets(level, case.target)
    yield f"cases:\n  - {{name: {level.case}, {start}{targets}}}"
    if _is_hidden(level):  # the last part of the way is learned first
        yield f"  - {{name: anywhere, start_anywhere: true{targets}}}"
    yield from _actions(level, len(starts))
    yield f"observation: {{{_observation(level)}, scale: 0.5}}"
    if conditions.charge:
        earned, asked = EARNED_BY_DOCKS, {"kind": "patrol", "stay": STAY_S}
        yield f"target: {{radius: {AT_DOCK_M:g}, measured_to: axle}}"
    else:
        settings = {each.name: getattr(goal, each.name) for each in fields(goal)}  # type: ignore[arg-type]  # a dataclass
        asked = {"kind": goal.kind} | {name: value for name, value in settings.items() if value is not None}
        earned = EARNED[goal.case_targets]
        yield f"target: {{radius: {case.target_radius:g}}}"
    yield f"reward: {{terms: {{{earned}}}}}"
    yield f"goal: {{{', '.join(f'{name}: {value}' for name, value in asked.items())}}}"
    seconds = level.time_limit
    if not goal.has_standing_targets:  # it could be slow: a drive that takes longer earns nothing
        seconds = min(seconds, LONGEST * (reference_seconds(level) or math.inf))
    steps = min(MAX_STEPS, round(seconds / STEP_S))
    yield f"step: {{time: {STEP_S:g}, collision_checks: 2, limit: {steps}}}"
    yield "start: {noise: 0.03, max_rotation: 0.4}"
    if conditions.acceleration:
        yield f"disturbances: {{inertia: {1.0 / conditions.acceleration:.5g}}}  # as on ice"
    yield "preset: hallway\nsuccess: 0.9"


def _is_hidden(level: GameLevel) -> bool:
    """Whether a single target is to be found in fog."""
    return level.conditions.fog and level.goal.case_targets is CaseTargets.PLACE


def _targets(level: GameLevel, target: tuple[float, float]) -> str:
    goal = level.goal
    if goal.needs_leader:
        return f", target_model: {level.leader}"
    places = list(level.targets or goal.route((target,)))
    if level.conditions.charge:
        dock = level.conditions.docks[0]
        later = [place for each in places[1:] for place in (dock, each)]
        places = [places[0], *later] if later else [dock, *places]
    if len(places) > 1:
        return f", targets: [{', '.join(map(_point, places))}]"
    return f", target: {_point(places[0])}" if places else ""


def _actions(level: GameLevel, robots: int) -> Iterator[str]:
    batch_map = load_batch_map(level.map_card)
    names: tuple[str, ...] = TWO_WHEELS
    turn = TURN_RATE
    if batch_map.robot.wheelbase:
        names, turn = TRICYCLE, batch_map.robot.max_turn_rate
    elif robots > 1:
        names, turn = PAIR, PAIR_TURN
    elif level.conditions.charge:
        names = ("stop", *(name for name in TWO_WHEELS if name != "back"))
    yield f"actions:\n  one_number: {str(robots == 1).lower()}\n  twists:"
    for name in names:
        speed = SPEED * (("forward" in name) - ("back" in name))
        side = ("left" in name) - ("right" in name)
        yield f"    {name}: [{speed:g}, {turn * side:g}]"


def _observation(level: GameLevel) -> str:
    conditions = level.conditions
    if conditions.wheel_error:  # it learns its way by what its lidar sees alone
        return "sectors: 31, clip: 4"
    if conditions.charge:
        frames = "" if needs_memory(level) else ", frames: 8"  # which tell how long it has stood
        return f"sectors: 13, own_pose: true, last_action: true{frames}"
    seen = f"sectors: 13, {SEEN[level.goal.case_targets]}"
    if _is_hidden(level):
        seen += ", own_pose: true"
    if conditions.acceleration:
        seen += ", speeds: true"
    return seen


def _pose(pose: Pose) -> str:
    return f"[{pose.x:g}, {pose.y:g}, {pose.theta:.5g}]"


def _point(place: tuple[float, float]) -> str:
    return f"[{place[0]:g}, {place[1]:g}]"

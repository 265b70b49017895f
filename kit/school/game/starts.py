"""The starts of a race: the level's own for a hand, five for a program or an agent, of which the middle drive counts.

A list of commands that is right for one start is wrong for another: the drawn starts shift the robots by centimetres and
degrees, let them veer, add noise to their lasers and move the traffic on. They are drawn anew for each race, so nobody can
prepare for them. Two and two lie on opposite sides of the level's own start (antithetic variates; Hammersley and Morton 1956):
what one gains the other loses, and the middle drive does not depend on luck. Which start a drive had is told by its seed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from random import Random
from typing import Final

import numpy as np

from kit.geometry import Pose
from kit.run.scenario import Scenario
from kit.school.game.levels import GameLevel
from kit.sim.plugins.diff_drive import DiffDriveParams
from kit.sim.plugins.laser import LaserParams
from kit.sim.plugins.tricycle_drive import TricycleDriveParams
from kit.sim.plugins.tween import ProgressCurve, TweenParams
from kit.sim.simulation import Simulation
from kit.world.records import Model

OWN_SEED: Final = 1
"""Seed of a drive from the level's own start."""
STARTS: Final = 5
"""Drives of a program or an agent on a level with medals: one from the level's own start, two from each of two pairs."""
MAX_PAIR: Final = 10**9
"""The pair of starts of number n has the seeds 2 n and 2 n + 1, for n from 1."""
SHIFT_M, SHIFT_RAD = (0.015, 0.04), (0.15, 0.35)
"""How far a drawn start lies from the level's own along each axis, at least and at most [m], and by how much it is turned
[rad]: little for who looks where the robot is, too much for a list of commands."""
VEER: Final = (0.1, 0.2)
"""Curvature of a robot's way at a drawn start when it is told to go straight, at least and at most, to either side [1/m]."""
LASER_NOISE_M: Final = 0.01
"""Standard deviation of a laser's noise at a drawn start [m]."""
OTHER_PHASE: Final = 0.5
"""How much farther the carts are at the second start of a pair, in ways from one end to the other."""
MAX_DRAWS: Final = 20
"""So often a pair of starts is drawn before the level's own start is taken: a robot must not stand in a wall."""


@dataclass(frozen=True, slots=True)
class LaterCurve:
    """The progress of a cart that has already gone on for a while."""

    progress: ProgressCurve
    turns: float
    """How far it has gone, in ways from one end to the other."""

    def __call__(self, turns: float) -> float:
        return self.progress(turns + self.turns)


def draw_seeds(level: GameLevel, random: Random) -> tuple[int, ...]:
    """Draws the seeds of a program's drives on a level, in rising order; only the own start where there are no medals."""
    if not level.has_medals:
        return (OWN_SEED,)
    pairs = sorted(random.sample(range(1, MAX_PAIR + 1), STARTS // 2))
    return (OWN_SEED, *(2 * pair + side for pair in pairs for side in (0, 1)))


def are_drawn(level: GameLevel, seeds: Sequence[int]) -> bool:
    """Whether ``draw_seeds`` can have drawn these seeds for a level."""
    if not level.has_medals:
        return tuple(seeds) == (OWN_SEED,)
    firsts = seeds[1::2]
    pairs = [seed for first in firsts for seed in (first, first + 1)]
    are_even = all(first % 2 == 0 for first in firsts)
    return len(set(seeds)) == STARTS and are_even and list(seeds) == [OWN_SEED, *pairs]


def scenario_from(level: GameLevel, seed: int) -> Scenario:
    """A level's scenario with the start of a drive. Raises as ``GameLevel.find_scenario``, and ValueError for a seed that
    no drive of the game has."""
    if not OWN_SEED <= seed <= 2 * MAX_PAIR + 1:
        raise ValueError(f"a drive of the game has a seed from {OWN_SEED} to {2 * MAX_PAIR + 1}, not {seed}")
    scenario = level.find_scenario()
    if seed == OWN_SEED:
        return scenario
    pair, side = divmod(seed, 2)
    random = np.random.default_rng([pair, *level.reference_id.encode()])
    for _ in range(MAX_DRAWS):
        both = _draw_pair(scenario, random)
        if all(map(_is_free, both)):
            return both[side]
    return scenario


def film_scenario(level: GameLevel, seed: int) -> Scenario:
    """The scenario of a drive as its film shows it, under the level's title. Raises as ``scenario_from``."""
    scenario = scenario_from(level, seed)
    case = None if scenario.case is None else replace(scenario.case, name=level.title)
    return replace(scenario, case=case)


def _draw_pair(scenario: Scenario, random: np.random.Generator) -> tuple[Scenario, Scenario]:
    """Two scenarios whose starts lie on opposite sides of the scenario's own."""
    phase = float(random.uniform(0.0, 2.0))
    least, most = np.transpose((SHIFT_M, SHIFT_M, SHIFT_RAD))
    x, y, turn = (random.uniform(least, most) * random.choice((-1.0, 1.0), 3)).tolist()
    veer = float(random.uniform(*VEER) * random.choice((-1.0, 1.0)))
    one = _disturb(scenario, phase, veer)
    other = _disturb(scenario, phase + OTHER_PHASE, -veer)
    return _shift_scenario(one, x, y, turn), _shift_scenario(other, -x, -y, -turn)


def _disturb(scenario: Scenario, phase: float, veer: float) -> Scenario:
    """The scenario with noise on its lasers, its carts on their way since ``phase`` and robots that do not go straight."""
    models = tuple(_disturb_model(model, phase, veer) for model in scenario.world.models)
    return replace(scenario, world=replace(scenario.world, models=models))


def _disturb_model(model: Model, phase: float, veer: float) -> Model:
    """A model with noise on its lasers and a drive that veers [1/m], or on its way since a while if it is a cart. ``phase``: as
    of ``LaterCurve``."""
    plugins = []
    for plugin in model.plugins:
        params = plugin.params
        if isinstance(params, LaserParams):
            params = replace(params, noise=math.hypot(params.noise, LASER_NOISE_M))
        elif isinstance(params, DiffDriveParams | TricycleDriveParams):
            params = replace(params, veer=params.veer + veer)
        elif isinstance(params, TweenParams) and params.progress is not None:
            params = replace(params, progress=LaterCurve(params.progress, phase))
        plugins.append(replace(plugin, params=params))
    return replace(model, plugins=tuple(plugins))


def _shift_scenario(scenario: Scenario, x: float, y: float, turn: float) -> Scenario:
    """The scenario with its robots shifted [m] and turned [rad] about the middle between them."""
    starts = scenario.starts
    middle = (sum(each.x for each in starts) / len(starts), sum(each.y for each in starts) / len(starts))
    cosine, sine = math.cos(turn), math.sin(turn)
    poses = {}
    for name, pose in zip(scenario.partners, starts, strict=True):
        dx, dy = pose.x - middle[0], pose.y - middle[1]
        poses[name] = Pose(
            middle[0] + cosine * dx - sine * dy + x,
            middle[1] + sine * dx + cosine * dy + y,
            pose.theta + turn,
        )
    models = tuple(replace(model, pose=poses.get(model.name, model.pose)) for model in scenario.world.models)
    return replace(scenario, world=replace(scenario.world, models=models))


def _is_free(scenario: Scenario) -> bool:
    """Whether no robot touches anything where it stands."""
    simulation = Simulation(scenario.world, seed=OWN_SEED, has_subscribers=lambda topic: False)
    simulation.step()
    return not any(simulation.is_touching(name) for name in scenario.partners)

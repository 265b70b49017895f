"""What the lessons on tables say is found out again: by the learning scenes that they show, and by single updates."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from kit.learning.environment.env import TurnEnv
from kit.learning.grid.grid_learner import GridLearner, GridLearnerSettings
from kit.learning.grid.grid_world import SMALL_TARGET, GridCell, GridWorld
from kit.learning.grid.registry import make_grid_learner
from kit.learning.policies.policy_network import ActionValueTable
from kit.learning.tasks.catalogue import TURN
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import TabularParams
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.presets import find_preset
from kit.learning.training.tabular import MAX_STATES
from kit.learning.training.training import make_learner
from kit.school.lessons.records import LearningScene, LessonStep
from tests.kit_content import kit_lesson
from tests.learning import worlds

SEEDS: Final = 60
SEEN: Final = int(TurnEnv().observation_space.shape[0])
COUNTS: Final = {0: "None", 1: "One", 2: "Two"}


def scene_of(step: LessonStep) -> LearningScene:
    assert step.learning is not None
    return step.learning


trained = cache(worlds.trained)
"""A learner after so many episodes; not to be changed."""


def learners_of(step: LessonStep) -> list[GridLearner]:
    """Those of the step's scene, at its end."""
    scene = scene_of(step)
    return [trained(scene.world, settings, scene.episodes) for settings in scene.learners]


def corridor(updates: int, alpha: float = 0.5, gamma: float = 0.9, length: int = 3) -> list[list[float]]:
    """The values along a corridor after each episode of moving right; the last move pays 1."""
    values, seen = [0.0] * length, []
    for _ in range(updates):
        for cell in range(length):
            target = 1.0 if cell == length - 1 else gamma * values[cell + 1]
            values[cell] += alpha * (target - values[cell])
        seen.append(list(values))
    return seen


def grid_rewards(words: str, step: LessonStep, folder: Path) -> str:
    world = scene_of(step).world
    (beside,) = (
        (cell, move)
        for cell in world.cells()
        for move in range(4)
        if not world.is_terminal(cell) and world.sign(cell) != "#"
        if world.step(cell, move).terminated and move == 0
    )
    paid = world.step(*beside)
    other = world.step(world.start, 0)
    assert paid.terminated
    return f"The target G pays {paid.reward:g} and ends the episode; every other move pays {other.reward:g}"


def grid_zeros(words: str, step: LessonStep, folder: Path) -> str:
    (settings,) = scene_of(step).learners
    values = make_grid_learner(scene_of(step).world, settings).values
    assert values.min() == values.max()
    return f"All of them begin at {values[0, 0, 0]:g}"


def first_success(words: str, step: LessonStep, folder: Path) -> str:
    """The step's own learner, until its first episode has ended at the target."""
    (settings,) = scene_of(step).learners
    learner = make_grid_learner(scene_of(step).world, settings)
    updates = [learner.step()]
    while not updates[-1].ended:
        updates.append(learner.step())
    changed = int(np.count_nonzero(learner.values))
    assert updates[-1].reward == 1.0
    if words.startswith("the first update"):
        assert [update.target != 0 for update in updates].index(True) == len(updates) - 1
        return "the first update whose target is not 0"
    if "last move" in words:
        return f"{COUNTS[changed]}, that of the last move."
    assert all(update.reward == 0 and update.target == 0 for update in updates[:-1])
    return "The other moves paid 0, and led to cells whose values were still 0"


def half_way(words: str, step: LessonStep, folder: Path) -> str:
    ((*_, value),) = corridor(1, alpha=0.5)
    return f"0.5 is { {0.5: 'half'}[value] } the way"


def towards_one(words: str, step: LessonStep, folder: Path) -> str:
    values = [0.0, *(each[-1] for each in corridor(3))]
    shown = [f"{value:g}" for value in values]
    return (
        f"With alpha 0.5 its value goes from {shown[0]} to {shown[1]}, then to {shown[2]}, then to {shown[3]}"
    )


def one_step_earlier(words: str, step: LessonStep, folder: Path) -> str:
    gamma = 0.5 if "0.5 a reward" in words else 0.9
    settled = corridor(500, gamma=gamma)[-1]
    share = settled[-2] / settled[-1]
    if words.startswith("With gamma"):
        return f"With gamma 0.5 a reward loses { {0.5: 'half'}[round(share, 6)] } its worth with each move"
    if words.startswith("The move before"):
        target = corridor(2, alpha=1.0, gamma=gamma)[0][-1] * 0.5 * gamma
        return f"The move before it has the target {gamma:g} x 0.5 = {target:g}"
    return f"how much a reward counts one step earlier: {share:.2g} of it"


def two_targets(words: str, step: LessonStep, folder: Path) -> str:
    world = scene_of(step).world
    far = world.shortest_path_length
    near = GridWorld(
        tuple(row.translate(str.maketrans("gG", "Gg")) for row in world.rows)
    ).shortest_path_length
    if "both" in words:
        assert far == near
        return f"Now both targets are {far} moves away"
    rewards = world.rewards
    return (
        f"`g` is {near} moves away and pays {rewards.small_target:g}, "
        f"`G` is {far} moves away and pays {rewards.target:g}."
    )


def _end_sign(learner: GridLearner) -> str:
    """The sign of the end to which the best moves lead."""
    return learner.world.sign(learner.greedy_path()[-1])


def near_or_far(words: str, step: LessonStep, folder: Path) -> str:
    one, other = learners_of(step)
    return (
        f"To {_end_sign(one)} with gamma {one.settings.gamma:g}, "
        f"to {_end_sign(other)} with gamma {other.settings.gamma:g}."
    )


def worth_at_start(words: str, step: LessonStep, folder: Path) -> str:
    """The value of S by each learner's table, and what the other target would be worth."""
    worth = {}
    for learner in learners_of(step):
        gamma, rewards = learner.settings.gamma, learner.world.rewards
        worth[gamma] = far, near = rewards.target * gamma**4, rewards.small_target * gamma**2
        assert abs(learner.values[learner.world.start].max() - max(far, near)) < 1e-3
    if words.startswith("G is"):
        return f"G is worth {worth[0.5][0]:g} at the start then, and g {worth[0.5][1]:g}"
    return (
        f"With 0.9 the start's value is 0.9 four times over, {worth[0.9][0]:.3f}, against {worth[0.9][1]:.3f}. "
        f"With 0.5 it is {worth[0.5][0]:g} against {worth[0.5][1]:g}"
    )


def scene_epsilon(words: str, step: LessonStep, folder: Path) -> str:
    """The numbers in the words are the scene's."""
    shown = {f"{settings.epsilon:g}" for settings in scene_of(step).learners}
    found = re.findall(r"epsilon (?:is )?(\d[\d.]*)", words)
    assert found
    assert set(found) <= shown
    if "half of the time" in words:
        assert found == ["0.5"]
    return words


def scene_alpha(words: str, step: LessonStep, folder: Path) -> str:
    shown = {f"{settings.alpha:g}" for settings in scene_of(step).learners}
    found = re.findall(r"alpha (\d[\d.]*)", words)
    assert found
    assert set(found) <= shown
    if "a tenth" in words:
        assert found == ["0.1", "1"]
    return words


def found_first(words: str, step: LessonStep, folder: Path) -> str:
    """The first end that the learner without exploration came to is the one it leads to."""
    scene = scene_of(step)
    learner = make_grid_learner(scene.world, scene.learners[0])
    while not learner.returns or learner.returns[-1] == 0:
        update = learner.step()
    assert learner.settings.epsilon == 0
    end = trained(scene.world, scene.learners[0], scene.episodes)
    assert scene.world.sign(update.reached) == _end_sign(end) == SMALL_TARGET
    assert _end_sign(trained(scene.world, scene.learners[1], scene.episodes)) == "G"
    if words.startswith("Its"):
        return f"Its value is above {0 * end.values[end.world.start].max():g}"
    return "Here that is g" if words.startswith("Here") else "The one that it found first."


def found_by_sixty(words: str, step: LessonStep, folder: Path) -> str:
    scene = scene_of(step)
    counts = {}
    for epsilon in (0.0, 0.5):
        many = (GridLearnerSettings(epsilon=epsilon, seed=seed) for seed in range(SEEDS))
        counts[epsilon] = sum(trained(scene.world, each, scene.episodes).is_solved for each in many)
    return (
        f"In {SEEDS} trainings, each with another seed, epsilon 0 found G in {counts[0.0]}, "
        f"and epsilon 0.5 in {counts[0.5]}"
    )


def both_arrive(words: str, step: LessonStep, folder: Path) -> str:
    one, other = learners_of(step)
    assert one.is_solved
    assert other.is_solved
    assert one.values.max() < other.values.max()
    (episodes,) = {each.episodes for each in (one, other)}
    return re.sub(r"\d+", str(episodes), words)


def table_states(words: str, step: LessonStep, folder: Path) -> str:
    """What the agent sees, and into how many parts each number is sorted; all of it fits into a table."""
    parts = len(TabularParams().edges) + 1
    assert parts**SEEN <= MAX_STATES
    assert parts == 3
    return f"sort each of its { {9: 'nine'}[SEEN] } distances into near"


@cache
def robots_table() -> ActionValueTable:
    """The table that ``kit train turn --algo q-learning`` begins with."""
    algorithm = find_algorithm("q-learning")
    learner = make_learner(
        algorithm, find_preset("kit", algorithm, TURN.preset), TaskSpec("turn"), TURN, seed=0
    )
    model = learner.policy().model
    assert isinstance(model, ActionValueTable)
    return model


def row_of(distances: list[float]) -> int:
    """The row of the table for what the robot measures [m]."""
    seen = np.array([distances], dtype=np.float32) * np.float32(TURN.observation.scale)
    return int(robots_table().states(seen)[0])


def table_edges(words: str, step: LessonStep, folder: Path) -> str:
    near, far = (each / TURN.observation.scale for each in robots_table().edges)
    return f"near (less than {near:.1f} m), middle and far ({far:.1f} m or more)"


def table_rows(words: str, step: LessonStep, folder: Path) -> str:
    """By the scans that lead to the first and to the last row, and by how far one distance moves the row."""
    assert row_of([0.0] * SEEN) == 0
    parts = [row_of([0.0] * (SEEN - 1) + [distance]) for distance in (0.2, 0.5, 2.0)]
    return {
        "from": f"from 0 to {row_of([2.0] * SEEN):,}",
        "write": f"write {parts[0]}, {parts[1]} or {parts[2]} for each",
        "a": f"a number in base {len(parts)}",
    }[words.split()[0]]


def table_row(words: str, step: LessonStep, folder: Path) -> str:
    """Of the picture's distances."""
    first = step.picture.splitlines()[0]
    distances = [float(each) for each in re.findall(r"\d\.\d+", first)]
    assert len(distances) == SEEN
    return f"1*3 + 0 = {row_of(distances):,}"


# SARSA on a cliff

CLIFF_SEEDS: Final = 12
LAST_EPISODES: Final = 100
NUMBER_NAMES: Final = {2: "two", 4: "four", 6: "Six", 10: "ten", 12: "twelve"}


def cliff_rewards(words: str, step: LessonStep, folder: Path) -> str:
    world = scene_of(step).world
    edge = world.start
    moved, fallen = world.step(edge, 1), world.step(edge, 0)
    assert not moved.terminated
    assert fallen.terminated
    shown = f"step costs {-moved.reward:g}"
    if words.startswith("Each"):
        return f"Each {shown}"
    return f"A {shown}. A fall costs {-fallen.reward:g} and ends the episode"


def cliff_epsilon(words: str, step: LessonStep, folder: Path) -> str:
    epsilon = scene_of(step).learners[0].epsilon
    if "four times" in words:
        return f"{ {0.4: 'four times in ten'}[epsilon] } (epsilon {epsilon:g})"
    share = {0.1: "once in ten moves"}[epsilon]
    return f"{share} it goes anywhere" if "anywhere" in words else f"{share} (epsilon {epsilon:g})"


def _rows_from_edge(learner: GridLearner) -> int:
    """Rows between the path and the edge, in its middle."""
    bottom, columns = learner.world.shape
    rows = [cell.row for cell in learner.greedy_path() if 0 < cell.column < columns - 1]
    assert len(set(rows)) == 1
    return bottom - 2 - rows[0]


def cliff_paths(words: str, step: LessonStep, folder: Path) -> str:
    one, other = learners_of(step)
    assert (one.settings.algorithm, other.settings.algorithm) == ("q-learning", "sarsa")
    assert (_rows_from_edge(one), _rows_from_edge(other)) == (0, 1)
    assert one.is_solved
    assert other.is_solved
    steps = len(one.greedy_path()) - 1, len(other.greedy_path()) - 1
    assert steps[0] == one.world.shortest_path_length
    if words.startswith("The best"):
        return "The best moves never fall"
    if words.startswith("Q-learning along"):
        return "Q-learning along the edge, SARSA a row away from it."
    return (
        f"Q-learning finds the shortest way, {steps[0]} moves. SARSA takes {steps[1]}, and stays a row away "
        "from the edge"
    )


def cliff_step_scene() -> LearningScene:
    """The scene of the lesson's first step, which the others speak of."""
    return scene_of(kit_lesson("21-sarsa-on-a-cliff").steps[0])


def over_the_edge(words: str, step: LessonStep, folder: Path) -> str:
    world = cliff_step_scene().world
    edge = GridCell(world.shape[0] - 2, 3)
    falls = [world.step(edge, move).terminated for move in range(4)]
    assert falls.count(True) == 1
    return f"On the edge, one random move in {NUMBER_NAMES[len(falls)]} goes over it."


def edge_cost(words: str, step: LessonStep, folder: Path) -> str:
    scene = cliff_step_scene()
    epsilon, fall = scene.learners[0].epsilon, -scene.world.rewards.cliff
    share, cells = epsilon / 4, scene.world.rows[-1].count("C")
    return (
        f"With epsilon {epsilon:g} that is {share:g} of all moves, and {share:g} x {fall:g} = {share * fall:g} is what "
        f"each step on the edge costs on average, beside the {-scene.world.rewards.step:g}. "
        f"{NUMBER_NAMES[cells]} steps there cost {cells * share * fall:g} more."
    )


def row_away(words: str, step: LessonStep, folder: Path) -> str:
    scene = cliff_step_scene()
    one, other = (trained(scene.world, settings, scene.episodes) for settings in scene.learners)
    more = len(other.greedy_path()) - len(one.greedy_path())
    return f"A row away costs {NUMBER_NAMES[more]} more steps."


@cache
def cliff_returns(algorithm: str) -> tuple[float, float]:
    """Mean returns over several seeds: of the last episodes of a training, and of the best moves alone."""
    scene = cliff_step_scene()
    (settings,) = (each for each in scene.learners if each.algorithm == algorithm)
    many = [trained(scene.world, replace(settings, seed=seed), scene.episodes) for seed in range(CLIFF_SEEDS)]
    assert all(each.is_solved for each in many)
    tested = np.mean([-(len(each.greedy_path()) - 1) for each in many])
    return float(np.mean([each.returns[-LAST_EPISODES:] for each in many])), float(tested)


def cliff_lengths(words: str, step: LessonStep, folder: Path) -> str:
    if "twelve" in words:
        return f"what {NUMBER_NAMES[CLIFF_SEEDS]} trainings of each earned"
    return f"in the last {LAST_EPISODES} of their {cliff_step_scene().episodes} episodes"


def while_learning(words: str, step: LessonStep, folder: Path) -> str:
    returns = {"Q-learning": cliff_returns("q-learning")[0], "SARSA": cliff_returns("sarsa")[0]}
    if "#" not in words:
        return "Q-learning {:.0f}, SARSA {:.0f}, as before".format(*returns.values())
    name = words.split()[0]
    longest = -min(returns.values())
    return f"{name} {'#' * round(30 * -returns[name] / longest)} {returns[name]:.1f}"


def cliff_tested(words: str, step: LessonStep, folder: Path) -> str:
    """The right option, and the wrong one with the two exchanged."""
    returns = [cliff_returns("q-learning")[1], cliff_returns("sarsa")[1]]
    exchanged = words.startswith("Q-learning -11")
    return "Q-learning {:.0f}, SARSA {:.0f}".format(*(reversed(returns) if exchanged else returns))


def careful_or_not(words: str, step: LessonStep, folder: Path) -> str:
    stumbling, steady = learners_of(step)
    assert {stumbling.settings.algorithm, steady.settings.algorithm} == {"sarsa"}
    assert steady.settings.epsilon == 0
    assert (_rows_from_edge(steady), _rows_from_edge(stumbling)) == (0, 2)
    if words.startswith("Along"):
        return "Along the edge, as Q-learning does."
    return f"goes {len(stumbling.greedy_path()) - 1} moves, two rows away from the edge"


TABLE_DERIVATIONS: Final = (
    grid_rewards,
    grid_zeros,
    first_success,
    half_way,
    towards_one,
    one_step_earlier,
    two_targets,
    near_or_far,
    worth_at_start,
    scene_epsilon,
    scene_alpha,
    found_first,
    found_by_sixty,
    both_arrive,
    table_states,
    table_edges,
    table_rows,
    table_row,
    cliff_rewards,
    cliff_epsilon,
    cliff_paths,
    over_the_edge,
    edge_cost,
    row_away,
    cliff_lengths,
    while_learning,
    cliff_tested,
    careful_or_not,
)

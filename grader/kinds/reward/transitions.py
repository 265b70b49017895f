"""The transitions of the grid model, with the facts that a reward is given."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from grader.kinds.reward.task_model import CELL, LAST_MOVES, MOVES, GridModel
from kit.arrays import BoolArray, IntArray
from kit.learning.maps.ray_directions import RAY_COUNT
from kit.learning.tasks.actions import Move
from kit.learning.tasks.transition import FAR, EpisodeState, Transition

MODEL_FACTS: Final = (
    "collided",
    "reached",
    "hit",
    "in_target",
    "was_in_target",
    "move",
    "previous_move",
    "pose",
    "previous_pose",
    "target",
    "to_go",
    "previous_to_go",
    "front",
    "distance",
    "previous_distance",
    "bearing",
    "previous_bearing",
    "max_steps",
)
"""Parameters of a reward function that the model can provide. The others (the step's number, the turns made so far, the
lidar's rays) depend on what the model leaves out."""
KIT_MOVES: Final = np.array([Move.FORWARD, Move.BACK, Move.LEFT, Move.RIGHT, -1])

KIT_TWISTS: Final = np.array([(0.3, 0.0), (-0.3, 0.0), (0.0, np.pi / 3), (0.0, -np.pi / 3)])
"""m/s and rad/s of these moves, as in the hallways."""
"""The kit's number for each of the model's moves; the last stands for no move."""

AGENT_SIGHT: Final = 2.0
"""m: how far the agent of the kit's tasks sees (dissertation, section 3.1.2)."""


@dataclass(frozen=True, eq=False)
class TransitionBatch:
    """Some transitions of a model, as states and moves."""

    model: GridModel
    states: IntArray
    moves: IntArray

    def __len__(self) -> int:
        return len(self.states)

    @classmethod
    def all(cls, model: GridModel) -> TransitionBatch:
        """Returns all transitions, ordered by state."""
        states = np.repeat(np.arange(model.states), len(MOVES))
        return cls(model, states, np.tile(np.arange(len(MOVES)), model.states))

    def at(self, index: IntArray) -> TransitionBatch:
        """Selects transitions by index."""
        return TransitionBatch(self.model, self.states[index], self.moves[index])

    @cached_property
    def next_states(self) -> IntArray:
        return self.model.next[self.states, self.moves]

    @property
    def hit(self) -> BoolArray:
        return self.model.hit[self.states, self.moves]

    @property
    def reached(self) -> BoolArray:
        return self.model.reached[self.states, self.moves]


def to_transition(steps: TransitionBatch) -> Transition:
    """Returns the kit's record of these transitions, for one robot."""
    model, count = steps.model, len(steps)
    front = np.minimum(
        model.ahead[model.cell_of(steps.next_states), model.heading_of(steps.next_states)], AGENT_SIGHT
    )
    standing = EpisodeState(
        case=np.zeros(count, dtype=np.int64),
        step=np.zeros(count, dtype=np.int64),
        pose=model.pose(steps.states)[:, None, :],
        hit=np.zeros((count, 1), dtype=np.bool_),
        in_target=np.zeros((count, 1), dtype=np.bool_),
        to_go=model.to_go[model.cell_of(steps.states)][:, None],
        rotation=np.zeros((count, 1)),
        ranges=np.repeat(front[:, None, None], RAY_COUNT, axis=2),
        move=KIT_MOVES[steps.states % LAST_MOVES][:, None],
        twist=np.zeros((count, 1, 2)),
        forward_steps=np.zeros((count, 1)),
        target=np.broadcast_to((model.cells[model.target] + 0.5) * CELL, (count, 2)),
        target_heading=np.zeros(count),
        obstacle_distance=np.full((count, 1), FAR),
        count=np.zeros(count),
        achieved=np.zeros(count),
    )
    moved = replace(
        standing,
        step=np.ones(count, dtype=np.int64),
        pose=model.pose(steps.next_states)[:, None, :],
        hit=steps.hit[:, None],
        in_target=steps.reached[:, None],
        to_go=model.to_go[model.cell_of(steps.next_states)][:, None],
        move=KIT_MOVES[steps.moves][:, None],
        twist=KIT_TWISTS[steps.moves][:, None, :],
        count=1.0 * steps.reached,
        achieved=1.0 * steps.reached,
    )
    return Transition(standing, moved, model.task.max_steps)

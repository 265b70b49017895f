"""The kit's own rewards on the small model: so that Algorithms 1 and 3 can be planned on like a student's."""

from __future__ import annotations

import numpy as np

from grader.model import LASTS, Floats, Model
from grader.transitions import Steps
from kit.learning.actions import Move
from kit.learning.observations import RAYS
from kit.learning.rewards import RewardFunction
from kit.learning.transition import Transition

MOVES = np.array([Move.FORWARD, Move.BACK, Move.LEFT, Move.RIGHT, -1])
"""The kit's number of each of the model's moves; the last: none."""


SIGHT = 2.0
"""m: no farther does the agent of these tasks see (dissertation, section 3.1.2)."""


def rewards_of(reward: RewardFunction, model: Model) -> Floats:
    """(states, moves) what the reward pays for every transition of the model.

    What a reward knows of an episode's past beyond the last move (the step's number, turns made so far) is not part of
    the model's states: every transition stands for one at the episode's beginning.
    """
    steps = Steps.all(model)
    return np.asarray(reward(transition(steps)), dtype=np.float64).reshape(model.states, -1)


def transition(steps: Steps) -> Transition:
    """Transitions of the model as the kit's record, for one robot."""
    model, count = steps.model, len(steps)
    column = steps.columns(("to_go", "previous_to_go", "front"))
    zeros = np.zeros((count, 1), dtype=np.int64)
    return Transition(
        case=np.zeros(count, dtype=np.int64),
        step=np.ones(count, dtype=np.int64),
        max_steps=model.task.max_steps,
        hit=steps.hit[:, None],
        in_target=steps.reached[:, None],
        was_in_target=zeros.astype(np.bool_),
        move=MOVES[steps.moves][:, None],
        previous_move=MOVES[steps.states % LASTS][:, None],
        pose=steps.after_pose[:, None, :],
        previous_pose=steps.before_pose[:, None, :],
        target=np.broadcast_to(steps.target, (count, 2)),
        to_go=np.asarray(column["to_go"])[:, None],
        previous_to_go=np.asarray(column["previous_to_go"])[:, None],
        full_turns=zeros,
        forward_steps=zeros.astype(np.float64),
        ranges=np.repeat(np.minimum(column["front"], SIGHT)[:, None, None], RAYS, axis=2),
    )

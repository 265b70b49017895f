"""The public Python names, from their docstrings, whose examples a test runs."""

from __future__ import annotations

from typing import Final

import kit
from kit.document.blocks import Chapter, Code
from kit.help.docstrings import docstring_blocks
from kit.help.topic import HelpTopic, Shelf, chapter
from kit.learning.authoring.task_text import fields_table


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter("For scripts and notebooks", *docstring_blocks(kit.__doc__ or "")),
        *(
            chapter(f"kit.{name}", *docstring_blocks(getattr(kit, name).__doc__ or ""))
            for name in kit.__all__
        ),
        chapter(
            "What a reward of your own gets",
            "`gymnasium.make(..., reward=function)` and `gymnasium.make_vec` call it once a step with one record, and it returns "
            "one finite number for each of n worlds; for a single environment n is 1. The record is a "
            "`kit.learning.tasks.transition.Transition`. Its fields are arrays of shape (n,), or (n, robots) where each robot has "
            "its own value. A reward file has the same names as the parameters of `reward()`.",
            Code(
                (
                    "def reward(step):",
                    "    return 2.0 * step.reached - 2.0 * step.collided + (step.previous_to_go - step.to_go).sum(axis=-1)",
                )
            ),
            fields_table(),
        ),
        chapter(
            "Several agents, and curves",
            "`kit.RobotsParallelEnv` is a PettingZoo parallel environment in which every robot is an agent. Every run of "
            "`kit train` has a folder `tensorboard`: `tensorboard --logdir runs/NAME/tensorboard` draws its curves.",
        ),
    )


TOPIC: Final = HelpTopic(
    "From Python", "the public names, with examples that run", Shelf.REFERENCE, _chapters
)

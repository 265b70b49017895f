"""Task cards of the registered environments in Gymnasium's form: made from the environments themselves."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

import gymnasium
from gymnasium import spaces

from kit.document.blocks import Block, CellStyle, Chapter, Column, Table
from kit.environment_ids import ENVIRONMENTS, register
from kit.help.docstrings import docstring_blocks
from kit.help.topic import HelpTopic, Shelf, chapter
from kit.learning.environment.env import TaskEnv
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.catalogue import all_tasks

_TEXT: Final = CellStyle.TEXT


def _chapters() -> tuple[Chapter, ...]:
    register()
    return (
        chapter(
            "Making one",
            """
`import kit` registers three environments with Gymnasium. Each takes a task: one of the kit's by name, a task file of
your own, or a variant from Python. `kit help python` shows training with stable-baselines3.

    import gymnasium, kit
    env = gymnasium.make("RobotKit/Turn-v0", case="turn_a_to_b")
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(0)

A version ends in `-v0`, `-v1`, ...: it is raised whenever the same actions would earn another reward or another observation.
""",
        ),
        *(_environment_chapter(name) for name in ENVIRONMENTS),
        chapter(
            "Arguments",
            *docstring_blocks(TaskEnv.__init__.__doc__ or ""),
            "`reset(seed=..., options=...)`. "
            + " ".join(re.sub(r"\s+", " ", TaskEnv.reset.__doc__ or "").replace("``", "`").split()),
            "`step(action)`. "
            + " ".join(re.sub(r"\s+", " ", TaskEnv.step.__doc__ or "").replace("``", "`").split()),
        ),
        chapter("Tasks that come with the kit", *_task_tables()),
    )


def _environment_chapter(name: str) -> Chapter:
    """One environment: the table at its top, and its docstring."""
    identifier = f"RobotKit/{name}-v0"
    env = gymnasium.make(identifier)
    wrapped = env.unwrapped
    assert isinstance(wrapped, TaskEnv)
    rows = (
        ("Action space", str(wrapped.action_space)),
        ("Observation space", str(wrapped.observation_space)),
        ("Cases", ", ".join(case.name for _, case in wrapped.task.map_cases())),
        ("Step", f"{wrapped.task.step_time:g} s, at most {wrapped.task.max_steps} in an episode"),
        ("Render modes", ", ".join(wrapped.metadata["render_modes"])),
        ("Creation", f'gymnasium.make("{identifier}")'),
    )
    card = Table(f"card-{name.lower()}", "", (Column("", _TEXT), Column("", _TEXT)), rows)
    blocks: list[Block] = [card, *docstring_blocks(type(wrapped).__doc__ or ""), *_action_tables(wrapped)]
    env.close()
    return chapter(name, *blocks)


def _action_tables(env: TaskEnv) -> Iterator[Table]:
    """What each number of a discrete action does."""
    space = env.action_space
    if not isinstance(space, (spaces.Discrete, spaces.MultiDiscrete)):
        return
    columns = (
        Column("Number", _TEXT),
        Column("Action", _TEXT),
        Column("Forward [m/s]"),
        Column("Turn [rad/s]"),
    )
    actions = env.task.actions
    assert isinstance(actions, DiscreteActions)
    rows = tuple(
        (str(number), name, *twist)
        for number, (name, twist) in enumerate(zip(actions.names, actions.twist_table, strict=True))
    )
    yield Table(f"actions-{type(env).__name__.lower()}", "Actions", columns, rows)


def _task_tables() -> Iterator[Table]:
    columns = (Column("Task", _TEXT), Column("What it is", _TEXT))
    rows = tuple((task.name, task.summary) for task in all_tasks())
    yield Table("tasks", "", columns, rows, note="`kit task show NAME` shows one with all it sets.")


TOPIC: Final = HelpTopic(
    "Environments", "task cards of the Gymnasium environments", Shelf.REFERENCE, _chapters
)

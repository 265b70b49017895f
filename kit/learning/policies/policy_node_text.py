"""The text of a policy's ROS 2 node: the kit's program around constants; and whether a file is such a text.

Whoever has only the text knows by it that a network or a table drives, and no program of somebody's own.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any, Final

GOAL_PROGRAMS: Final = "kit.learning.policies.node_goals"
LEARNED_MARK: Final = "# --- what was learned ---\n"
COUNT_MARK: Final = "# --- how its goal is counted ---\n"
TITLE: Final = "TRAINED_ON"
"""The constant that says what the policy was trained on, which does nothing."""


def node_text(constants: str, goal_kind: str | None) -> str:
    """The program with its constants. ``goal_kind``: of the goal that it counts; None: it is not told how much is achieved."""
    head, between, rest = _template()
    learned = f"{LEARNED_MARK}{constants}{LEARNED_MARK}"
    return f"{head}{learned}{between}{COUNT_MARK}{_count_text(goal_kind)}{COUNT_MARK}{rest}"


def learned_constants(text: str) -> Mapping[str, Any] | None:
    """The constants of a text that ``node_text`` gives, by name; None for any other text.

    >>> constants = "".join(f"{name} = []\\n" for name in sorted(constant_names()))
    >>> sorted(learned_constants(node_text(constants, None))) == sorted(constant_names())
    True
    >>> learned_constants(node_text(constants, None) + "print('and more')\\n") is None
    True
    """
    head, _, after = text.partition(LEARNED_MARK)
    learned, _, after = after.partition(LEARNED_MARK)
    between, _, after = after.partition(COUNT_MARK)
    count, _, rest = after.partition(COUNT_MARK)
    if (head, between, rest) != _template() or count not in map(_count_text, (None, *_goal_kinds())):
        return None
    try:
        found = {
            each.targets[0].id: ast.literal_eval(each.value)  # type: ignore[attr-defined]  # else caught below
            for each in ast.parse(learned).body
        }
    except (AttributeError, SyntaxError, ValueError, TypeError, RecursionError, MemoryError):
        return None
    return found if found.keys() == constant_names() else None


def can_count(goal_kind: str) -> bool:
    """Whether a node can count how much of a goal is achieved."""
    return goal_kind in _goal_kinds()


@cache
def constant_names() -> frozenset[str]:
    """The names of the constants."""
    learned = _template_text().split(LEARNED_MARK)[1]
    targets = [
        target
        for each in ast.parse(learned).body
        for target in ([each.target] if isinstance(each, ast.AnnAssign) else getattr(each, "targets", []))
    ]
    return frozenset(each.id for target in targets for each in ast.walk(target) if isinstance(each, ast.Name))


@cache
def _template_text() -> str:
    return files("kit.learning.policies").joinpath("policy_node_template.py").read_text()


@cache
def _template() -> tuple[str, str, str]:
    """What stands before, between and after what differs from node to node."""
    head, _, after = _template_text().partition(LEARNED_MARK)
    between, _, after = after.partition(LEARNED_MARK)[2].partition(COUNT_MARK)
    return head, between, after.partition(COUNT_MARK)[2]


@cache
def _count_text(goal_kind: str | None) -> str:
    """The classes by which a node counts a goal, as their files have them; None: those of a node that is not told."""
    common = _class_text("goal_count")
    own = "" if goal_kind is None else _class_text(goal_kind)
    name = own.removeprefix("class ").partition("(")[0] or "NodeCount"
    return f"{common}{own}COUNT = {name}\n\n\n"


def _class_text(module: str) -> str:
    """What a file holds from its first class on."""
    program = files(GOAL_PROGRAMS).joinpath(f"{module}.py").read_text()
    return "class " + program.partition("\nclass ")[2].rstrip() + "\n\n\n"


@cache
def _goal_kinds() -> tuple[str, ...]:
    names = [each.name for each in files(GOAL_PROGRAMS).iterdir() if each.name.endswith(".py")]
    return tuple(name.removesuffix(".py") for name in names if name not in ("__init__.py", "goal_count.py"))

"""Every check of a world by name, and what is said about those that lose points."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any, Final

from grader.check import Check
from grader.kinds.world.content_checks import CONTENT_CHECKS
from grader.kinds.world.faults import WorldContents, WorldRun
from grader.kinds.world.layer_checks import LAYER_CHECKS
from grader.kinds.world.model_checks import MODEL_CHECKS
from grader.kinds.world.run_checks import RUN_CHECKS
from grader.problem_text import numbered

CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (*CONTENT_CHECKS, *MODEL_CHECKS, *LAYER_CHECKS, *RUN_CHECKS)}
)
"""Every check of a world, by name."""
NAMES_NEEDING_RUN: Final = frozenset(each.name for each in RUN_CHECKS)
"""Names of those that need a run."""
MAX_FAULTS_SHOWN: Final = 4
"""Faults of one check."""


def explain(content: WorldContents | WorldRun, name: str, params: Any) -> str:
    """Explains what a check found wrong with a world, in words that help to correct it."""
    problems = content.world.problems
    if name == "loads":
        return numbered(problems)
    if problems:
        return "The world cannot be read yet."
    if isinstance(content, WorldRun) and content.run.problem:
        return content.run.problem
    faults = CHECKS[name].faults
    return "" if faults is None else join_faults(faults(content, params))


def join_faults(faults: Iterable[str]) -> str:
    """Joins faults into one sentence; of many only the first."""
    every_fault = tuple(faults)
    more = f"; and {len(every_fault) - MAX_FAULTS_SHOWN} more" if len(every_fault) > MAX_FAULTS_SHOWN else ""
    text = "; ".join(every_fault[:MAX_FAULTS_SHOWN]) + more
    return text if not text or text[-1] in ".?" else f"{text}."

"""A curriculum: which cases are practised first, and how well before the next ones come (Bengio and others 2009)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kit.arrays import FloatArray
from kit.plain_text import quoted, suggestion
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class CurriculumStage:
    """Some of the cases, until all of them go well enough. After the last stage all cases are practised."""

    on: tuple[str, ...]
    """Cases or groups of cases."""
    success: float
    """The next stage comes when each of these cases succeeds this often in a test."""


Curriculum = tuple[CurriculumStage, ...]


def read_curriculum(sections: Sequence[Section], cases: Sequence[tuple[str, str]]) -> Curriculum:
    """Reads the stages from a task's file; ``cases``: the name and group of each case. What is wrong is noted."""
    known = tuple(dict.fromkeys(name for case in cases for name in case if name))
    stages = []
    for section in sections:
        names = section.texts("on", at_least=1)
        for name in names:
            if cases and name not in known:
                section.error(f"there is no case or group {quoted(name)}: {suggestion(name, known)}", "on")
        stages.append(CurriculumStage(names, section.number("success", 0.9, above=0, maximum=1)))
        section.finish()
    return tuple(stages)


@dataclass(frozen=True, slots=True)
class CasePractice:
    """Which of a task's cases are practised in a stage."""

    cases: tuple[str, ...]
    success: float

    def is_over(self, shares: dict[str, float]) -> bool:
        """Whether each of its cases succeeds often enough; ``shares``: by case."""
        return all(shares[name] >= self.success for name in self.cases)

    def world_shares(self, names: Sequence[str]) -> FloatArray:
        """(cases,) which part of the worlds each of the task's cases gets."""
        practised: FloatArray = np.array([float(name in self.cases) for name in names])
        practised /= practised.sum()
        return practised


def practices(curriculum: Curriculum, cases: Sequence[tuple[str, str]]) -> tuple[CasePractice, ...]:
    """The stages on the cases that there are, each with its name and group; a stage that has none of them is left out."""
    found = []
    for stage in curriculum:
        names = tuple(name for name, group in cases if {name, group} & set(stage.on))
        if names:
            found.append(CasePractice(names, stage.success))
    return tuple(found)

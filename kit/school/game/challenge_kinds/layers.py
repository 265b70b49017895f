"""Beat a layer plan: as few layers as a list of who collides and who is seen allows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import yaml

from kit.layers.assignment import LayerAssignment, NamedLayer, find_breaches
from kit.layers.planning import solve_layers
from kit.layers.requirements import LayerCase
from kit.layers.requirements_file import read_requirements
from kit.school.game.challenge import ChallengeError, ChallengeTask, HandedIn, Judgement, judge_count
from kit.school.game.medal import Medal
from kit.world.documents import open_document
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class LayersTask(ChallengeTask):
    """A layer case to plan."""

    kind = "layers"
    answer_file = "plan.yaml"

    file: Path

    @classmethod
    def read(cls, section: Section, folder: Path) -> Self:
        return cls(folder / section.text("case"))

    def lines(self) -> list[str]:
        return self.file.read_text().rstrip().splitlines()

    def naive_answer(self) -> str:
        return format_plan(naive_plan(read_requirements(self.file).case))

    def read_answer(self, file: Path) -> str:
        return str(file)  # read as a document, so that a mistake has its line

    def judge(self, handed_in: HandedIn) -> Judgement:
        return judge_assignment(self, read_plan(Path(handed_in.answer)))


def naive_plan(case: LayerCase) -> LayerAssignment:
    """A layer of its own for every requirement: the naive answer."""
    layers: list[NamedLayer] = []
    watches: dict[str, list[str]] = {}
    for number, contact in enumerate(sorted(case.collide, key=str), 1):
        layers.append(NamedLayer(f"layer {number}", frozenset((contact.a, contact.b))))
    for laser in case.lasers:
        for entity in sorted(laser.sees):
            layers.append(NamedLayer(f"{laser.name} sees {entity}", frozenset((entity,))))
            watches.setdefault(laser.name, []).append(layers[-1].name)
    return LayerAssignment(tuple(layers), {laser: tuple(names) for laser, names in watches.items()})


def format_plan(plan: LayerAssignment) -> str:
    """A plan as an answer's file holds it."""
    content = {
        "layers": {layer.name: sorted(layer.members) for layer in plan.layers},
        "lasers": {laser: list(names) for laser, names in plan.watches.items()},
    }
    return str(yaml.safe_dump(content, sort_keys=False, width=math.inf))


def read_plan(file: Path) -> LayerAssignment:
    """Reads the plan of an answer's file. Raises ChallengeError and WorldError."""
    if not file.is_file():
        raise ChallengeError(f"{file}: there is no such file.")
    with open_document(file.absolute(), is_partial=True) as section:
        layers = section.section("layers")
        lasers = None if section.is_blank("lasers") else section.section("lasers")
        named = tuple(NamedLayer(name, frozenset(layers.texts(name))) for name in sorted(layers.keys()))
        watches = {} if lasers is None else {name: lasers.texts(name) for name in sorted(lasers.keys())}
    return LayerAssignment(named, watches)


def judge_assignment(task: LayersTask, plan: LayerAssignment) -> Judgement:
    """Judges a plan by its breaches, and by its layers against the fewest and the naive plan's."""
    case = read_requirements(task.file).case
    breaches = find_breaches(case, plan)
    if breaches:
        return Judgement(Medal.NONE, f"It does not do what is asked: {breaches[0]}.")
    count, naive = len(plan.layers), len(naive_plan(case).layers)
    fewest = len(solve_layers(case).assignment.layers)
    text = f"{count} layers; a layer for every line takes {naive}, and {fewest} are enough."
    return judge_count("layers", text, count, fewest, naive)


KIND = LayersTask

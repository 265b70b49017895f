"""Beat a layer plan: as few layers as a list of who collides and who is seen allows."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final, Self

import yaml

from kit.document.rows import Row, row
from kit.layers.assignment import LayerAssignment, NamedLayer, find_breaches
from kit.layers.drawing.graph import draw_graph
from kit.layers.drawing.spans import GlyphStyle, drawn
from kit.layers.planning import solve_layers
from kit.layers.requirements import ContactRequirement, LayerCase
from kit.layers.requirements_file import read_requirements
from kit.plain_files import is_file_there
from kit.plain_text import counted, wrap
from kit.school.game.board import Board, History
from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask
from kit.school.game.judgement import Judgement, judge_count
from kit.school.game.medal import Medal
from kit.world.documents import open_document
from kit.world.problems import WorldError
from kit.world.yaml_section import Section

MAX_LAYERS: Final = 16
"""That a world can have."""
LEAST_DRAWING: Final = (30, 9)
"""Columns and rows."""


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

    def board(self, answer: str) -> Board:
        return LayersBoard(self, answer)

    def judge(self, submission: AnswerSubmission) -> Judgement:
        return judge_assignment(self, read_plan(Path(submission.answer)))

    def shared_text(self, answer: str) -> str:
        return Path(answer).read_text(encoding="utf-8")

    def judge_shared(self, text: str) -> Judgement:
        with TemporaryDirectory() as folder:
            file = Path(folder) / self.answer_file
            file.write_text(text, encoding="utf-8")
            return judge_assignment(self, read_plan(file))


class LayersBoard(Board):
    """A table of entities and lasers by layers: Space puts one into a layer, and what is still wrong is counted."""

    keys = "Arrows move, Space puts into a layer or takes out of it, u undoes it."
    signs = "Lines join what must collide, all else must not; o is a laser, # a map."
    mark_word = "put"

    def __init__(self, task: LayersTask, answer: str) -> None:
        self._task = task
        self._case = read_requirements(task.file).case
        self._names = (*self._case.names, *(laser.name for laser in self._case.lasers))
        self._layers: tuple[frozenset[str], ...] = ()
        """Of each layer the entities in it, and the lasers that watch it."""
        self._row = self._column = 0
        self._history: History[tuple[frozenset[str], ...]] = History()
        with suppress(AnswerError, WorldError):
            plan = read_plan(Path(answer))
            if not find_breaches(self._case, plan) and len(plan.layers) < len(naive_plan(self._case).layers):
                self._layers = tuple(
                    layer.members
                    | {laser for laser, watched in plan.watches.items() if layer.name in watched}
                    for layer in plan.layers
                )

    @property
    def _make_plan(self) -> LayerAssignment:
        lasers = {laser.name for laser in self._case.lasers}
        layers = tuple(
            NamedLayer(f"layer {number}", members - lasers) for number, members in enumerate(self._layers, 1)
        )
        watches = {
            laser: tuple(
                layer.name for layer, members in zip(layers, self._layers, strict=True) if laser in members
            )
            for laser in sorted(lasers)
        }
        return LayerAssignment(layers, watches)

    @property
    def answer(self) -> str:
        return format_plan(self._make_plan)

    def judgement(self) -> Judgement:
        return judge_assignment(self._task, self._make_plan)

    def drawing(self, width: int, height: int, glyphs: GlyphStyle) -> list[Row]:
        """The collision graph: what must collide as lines, faint while it does not, thick where the cursor's layer makes it
        collide; what collides and must not as others; beams from a laser under the cursor to what it must see."""
        if width < LEAST_DRAWING[0] or height < LEAST_DRAWING[1]:
            return []
        missing: set[ContactRequirement] = set()
        wrong: set[ContactRequirement] = set()
        for each in find_breaches(self._case, self._make_plan):
            if isinstance(each.requirement, ContactRequirement):
                (missing if each.is_missing else wrong).add(each.requirement)
        members = self._layers[self._column] if self._column < len(self._layers) else frozenset()
        here = self._names[self._row]
        lines = draw_graph(
            self._case,
            struck=missing,
            wrong=wrong,
            group=members,
            laser=here if here in self._case.laser else None,
            cursor=here,
            width=width,
            height=height,
            glyphs=glyphs,
            boxes=True,
        )
        return drawn(lines)

    def details(self, width: int) -> list[list[Row]]:
        """All that is still wrong."""
        wrong = find_breaches(self._case, self._make_plan)
        lines = (line for each in wrong for line in wrap(str(each), width, "  ", "    "))
        return [[row(("still wrong", "title")), *map(row, lines)]] if wrong else []

    def move(self, columns: int, rows: int) -> None:
        self._row = max(0, min(self._row + rows, len(self._names) - 1))
        self._column = max(0, min(self._column + columns, min(len(self._layers), MAX_LAYERS - 1)))

    def mark(self) -> None:
        self._history.note(self._layers)
        layers = [*self._layers, frozenset()] if self._column == len(self._layers) else [*self._layers]
        layers[self._column] ^= {self._names[self._row]}
        self._layers = tuple(each for each in layers if each)
        self._column = min(self._column, len(self._layers))

    def undo(self) -> None:
        self._layers = self._history.take(self._layers)
        self._column = min(self._column, len(self._layers))

    def rows(self, scale: int = 1) -> list[Row]:
        width = max(len(name) for name in self._names) + 2
        columns = min(len(self._layers) + 1, MAX_LAYERS)
        wrong = find_breaches(self._case, self._make_plan)
        about = {word for each in wrong for word in str(each).replace(",", " ").split()}
        rows = [row(("  " + " " * width + "".join(f"{number + 1:>3}" for number in range(columns)), "dim"))]
        for number, name in enumerate(self._names):
            is_laser = number >= len(self._case.names)
            cells: list[tuple[str, str]] = [
                (f"  {'o ' if is_laser else '  '}{name:<{width - 2}}", "" if name in about else "good")
            ]
            for column in range(columns):
                members = self._layers[column] if column < len(self._layers) else frozenset()
                is_here = (number, column) == (self._row, self._column)
                sign = ("o" if is_laser else "x") if name in members else "."
                cells += [("  ", ""), (sign, "chosen" if is_here else "" if name in members else "dim")]
            rows.append(tuple(cells))
        count = "all is as asked" if not wrong else f"{len(wrong)} still wrong"
        return [*rows, row(), row((f"  {counted(len(self._layers), 'layer')}", "bold"), f"; {count}")]


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
    """Reads the plan of an answer's file. Raises AnswerError and WorldError."""
    if not is_file_there(file):
        raise AnswerError(f"{file}: there is no such file.")
    with open_document(file.absolute(), is_partial=True) as section:
        layers = section.section("layers")
        lasers = None if section.is_blank("lasers") else section.section("lasers")
        named = tuple(NamedLayer(name, frozenset(layers.texts(name))) for name in sorted(layers.keys()))
        watches = {} if lasers is None else {name: lasers.texts(name) for name in sorted(lasers.keys())}
    return LayerAssignment(named, watches)


@cache
def _case_and_fewest(file: Path) -> tuple[LayerCase, int]:
    """A case and the number of layers than which no plan for it has fewer."""
    case = read_requirements(file).case
    return case, len(solve_layers(case).assignment.layers)


def judge_assignment(task: LayersTask, plan: LayerAssignment) -> Judgement:
    """Judges a plan by its breaches, and by its layers against the fewest and the naive plan's."""
    case, fewest = _case_and_fewest(task.file)
    breaches = find_breaches(case, plan)
    if breaches:
        return Judgement(Medal.NONE, f"It does not do what is asked: {breaches[0]}.")
    count, naive = len(plan.layers), len(naive_plan(case).layers)
    text = f"{counted(count, 'layer')}; a layer for every line takes {naive}, and {fewest} are enough."
    return judge_count("layers", text, count, fewest, naive)


KIND = LayersTask

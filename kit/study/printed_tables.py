"""The tables that the dissertation prints, typed in as data, and the list of its figures; a strict reader of both."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from kit.plain_text import quoted
from kit.world.documents import open_document
from kit.world.yaml_section import Section

CHAPTER_FILES: Final = tuple(Path(__file__).with_name(f"chapter_{number}.yaml") for number in (3, 4, 5))

EMPTY_CELL: Final = "-"
POTENTIAL_FIELDS: Final = "fields"
"""Stands for the group of a column that a controller drove, not an agent."""
SUCCESS, ADJACENCY, ADJACENCY_BY_POSES = MEASURES = ("success", "adjacency", "adjacency by poses")
"""What a test measures."""
STEPS: Final = "steps"
"""The steps of a training."""
WITH_TARGET: Final = "target"
"""Stands for the group of agents that are trained on all cases and told distance and rotation to the target (section 3.2.2)."""
FIGURE: Final = "figure-"
"""Begins the number of a figure's own training."""
SESSION_PLOTS: Final = ("outcomes", "reward", "adjacency", "values")
SOURCES: Final = ("code", "text")
"""Where the settings of a training come from: the dissertation's code, or its text."""
SUMMARY_ROWS: Final = ("mean", "SD")
_GROUP_LETTERS: Final[Mapping[str, float]] = {"B": 0.0, "E": 1.0}


@dataclass(frozen=True, slots=True)
class PrintedTable:
    """A table as the dissertation prints it."""

    id: str
    """Its number, such as ``3.5``."""
    title: str
    columns: tuple[str, ...]
    rows: Mapping[str, tuple[float, ...]]
    """Rows by label. NaN: no number is printed. Beginner is 0, expert 1."""
    decimals: tuple[int, ...]
    """For each column: the most that one of its numbers has."""
    section: str
    settings: tuple[str, ...] = ()
    tasks: tuple[str, ...] = ()
    """The kit's tasks that have the table's cases."""
    cases: tuple[tuple[str, str], ...] = ()
    """For the first rows, in order: the map and the case that it was tested on."""
    groups: tuple[str, ...] = ()
    """For each column: the group of cases trained on, ``all``, or the controller that drove."""
    row_groups: tuple[str, ...] = ()
    """For the first rows, where rows are trainings: the group of cases trained on."""
    seed_rows: bool = False
    """Whether the first rows are attempts at the same training: ours begin at the seeds 0, 1, ..."""
    measures: tuple[str, ...] = ()
    """For each column, where ours can stand against it: one of ``MEASURES`` or ``steps``."""
    results_of: str = ""
    """The number of the table whose agents these are; empty for its own."""
    repeat_task: str = ""
    """The task with the dissertation's settings, on which ``kit study NUMBER --again`` trains; empty if it cannot."""
    kit_task: str = ""
    """The same for the kit's own preset."""
    algorithm: str = "boltzmann-dqn"
    """The dissertation's; the kit's own preset is always for PPO."""
    keep_training: int = 0
    """Steps of trainings that go on whatever tests say; 0 for those that end with a good test."""
    steps_table: str = ""
    """The number of the table that prints the steps of these trainings; empty if it does so itself."""
    run: str = ""
    """The command whose results stand against it; empty if there is none."""
    missing: str = ""
    """What that command does not give."""
    seeds: int = 0
    """How many trainings by its settings are planned, from the seeds 0, 1, ...; 0: no plan."""
    settings_of: str = ""
    """One of ``SOURCES``."""
    prints_best_test: bool = False
    """Whether the print is the best test of one training: then seeds stand against it by their best tests."""

    def cell(self, row: str, column: str) -> float:
        """KeyError or ValueError if there is none."""
        return self.rows[row][self.columns.index(column)]

    @property
    def trained_groups(self) -> tuple[str, ...]:
        """The groups of cases that its agents were trained on, where the kit can train them again."""
        groups = (*self.row_groups, *self.groups) if self.repeat_task else ()
        return tuple(dict.fromkeys(each for each in groups if each != POTENTIAL_FIELDS))

    @property
    def has_potential_fields(self) -> bool:
        """Whether potential fields drove in some of its columns."""
        return POTENTIAL_FIELDS in self.groups

    @property
    def rows_without_means(self) -> list[str]:
        return list(self.rows)[: len(self.cases) or self.attempts]

    @property
    def attempts(self) -> int:
        """How many of its first rows are attempts at one training."""
        return sum(row not in SUMMARY_ROWS for row in self.rows) if self.seed_rows else 1

    def training_group(self, row: int, column: int) -> str:
        """The group of the training that a row and a column, by number, are about; empty for a row of means."""
        if self.row_groups:
            return self.row_groups[row] if row < len(self.row_groups) else ""
        return self.groups[column] if self.groups and row < self.attempts else ""

    def column_of(self, group: str, measure: str) -> str | None:
        """The title of the column; None if there is none."""
        found = zip(self.columns, self.groups, self.measures, strict=True) if self.groups else ()
        return next((title for title, *rest in found if rest == [group, measure]), None)

    def case_cells(self, column: str) -> dict[str, float]:
        """The column's numbers by case, without empty ones."""
        labels = zip(self.cases, self.rows, strict=False)
        found = {case: self.cell(row, column) for (_, case), row in labels}
        return {case: number for case, number in found.items() if not math.isnan(number)}


@dataclass(frozen=True, slots=True)
class PrintedFigure:
    """A figure of the dissertation: what it shows, and what shows the same here."""

    id: str
    title: str
    section: str
    run: str = ""
    plots: tuple[str, ...] = ()
    """Plots of the evaluation's report."""
    missing: str = ""
    results_of: str = ""
    """The number of the table one of whose trainings it shows."""
    group: str = ""
    """The cases that this agent was trained on."""
    sessions: str = ""
    """What it shows of the tests during training: ``outcomes``, ``reward`` or ``adjacency``."""
    repeat_task: str = ""
    """The task of a training of its own, which ``kit study figure NUMBER --again`` makes."""
    steps: int = 0
    """Steps of that training."""
    paths: tuple[tuple[str, str], ...] = ()
    """The map and case of each picture of ways, driven by an agent of ``results_of`` or by potential fields."""
    episodes: int = 0
    """Ways in each picture."""
    settings: tuple[str, ...] = ()

    @property
    def training(self) -> PrintedTable | None:
        """The training of its own as a table without cells, so that it is made and recorded like those of tables."""
        if not self.repeat_task:
            return None
        return PrintedTable(
            f"{FIGURE}{self.id}",
            self.title,
            (),
            {},
            (),
            self.section,
            row_groups=(self.group,),
            repeat_task=self.repeat_task,
            keep_training=self.steps,
        )


@dataclass(frozen=True, slots=True)
class MisprintCell:
    """One printed number that is wrong."""

    row: str
    column: str
    ours: float
    """The right value, rounded as it would be printed."""


@dataclass(frozen=True, slots=True)
class Misprint:
    """Printed numbers that are wrong for one reason; or a sentence of the text that its table does not bear out."""

    table: str
    why: str
    cells: tuple[MisprintCell, ...]
    """Empty where the text is wrong, not the table."""


@dataclass(frozen=True, slots=True)
class StudyChapter:
    """A chapter of the dissertation."""

    number: int
    title: str
    tables: tuple[PrintedTable, ...]
    figures: tuple[PrintedFigure, ...]
    misprints: tuple[Misprint, ...]

    def misprints_of(self, table: str) -> tuple[Misprint, ...]:
        return tuple(each for each in self.misprints if each.table == table)


@cache
def study_chapters() -> tuple[StudyChapter, ...]:
    """Chapters 3 to 5, without the tables that the evaluation's raw answers give (5.4 to 5.9)."""
    return tuple(read_study_chapter(file) for file in CHAPTER_FILES)


def printed_table(number: str) -> PrintedTable:
    """A table of ``study_chapters``, or the training of a figure: ``figure-3.5``. LookupError if there is none."""
    for chapter in study_chapters():
        for figure in chapter.figures:
            if figure.training is not None and figure.training.id == number:
                return figure.training
        for table in chapter.tables:
            if table.id == number:
                return table
    raise LookupError(f"There is no Table {number} among the printed ones.")


def parts_of(number: str) -> tuple[PrintedTable, ...]:
    """The tables whose agents are some of those of another one.

    >>> [table.id for table in parts_of("4.6")]
    ['4.4', '4.5']
    """
    return tuple(
        table for chapter in study_chapters() for table in chapter.tables if table.results_of == number
    )


def path_figures(table: str) -> tuple[PrintedFigure, ...]:
    """The pictures of ways that agents or controllers of a table drove.

    >>> [figure.id for figure in path_figures("3.5")]
    ['3.9']
    """
    return tuple(
        figure
        for chapter in study_chapters()
        for figure in chapter.figures
        if figure.paths and figure.results_of == table
    )


def printed_means(task: str) -> tuple[str, Mapping[str, float]]:
    """What a cross table of ``task`` compares with: the number of the printed table, and for each group of cases that an
    agent was trained on the mean success over all cases tested.

    Empty where the dissertation has no such table.

    >>> printed_means("hallway")[1]["doors"]
    0.797
    >>> printed_means("turn")
    ('', {})
    """
    for table in (each for chapter in study_chapters() for each in chapter.tables):
        if task in table.tasks and table.cases:
            means = {}
            for group in dict.fromkeys(table.groups):
                column = table.column_of(group, SUCCESS)
                cells = table.case_cells(column) if column else {}
                if len(cells) == len(table.cases):
                    means[group] = round(math.fsum(cells.values()) / len(cells), 3)
            return table.id, means
    return "", {}


def read_study_chapter(file: Path) -> StudyChapter:
    """Raises WorldError with all mistakes of the file."""
    with open_document(file) as section:
        tables = tuple(read_printed_table(each, allow_empty=True) for each in section.sections("tables"))
        return StudyChapter(
            section.integer("chapter", minimum=1),
            section.name("title"),
            tables,
            tuple(_read_figure(each) for each in section.sections("figures")),
            tuple(read_misprint(each, tables) for each in section.sections("slips")),
        )


def read_printed_table(section: Section, *, allow_empty: bool = False) -> PrintedTable:
    """``allow_empty``: a hyphen may stand for a cell without a number."""
    columns = section.texts("columns", at_least=1)
    rows, decimals = _read_rows(section, columns, allow_empty=allow_empty)
    cases = tuple(_read_case(section, each) for each in section.texts("cases", ()))
    groups = section.texts("groups", ())
    row_groups = section.texts("row_groups", ())
    measures = section.texts("measures", (SUCCESS,) * len(groups))
    if len(cases) > len(rows) or len(row_groups) > len(rows):
        section.error(f'"cases" or "row_groups" names more than the {len(rows)} rows')
    if groups and len(groups) != len(columns):
        section.error(f'"groups" must have one entry for each of {len(columns)} columns', "groups")
        groups = ()
    if (groups or row_groups) and len(measures) != len(columns):
        section.error(f'"measures" must have one entry for each of {len(columns)} columns', "measures")
        groups, row_groups, measures = (), (), ()
    if not set(measures) <= {*MEASURES, STEPS}:
        section.error(f'"measures" must hold only {", ".join(map(quoted, (*MEASURES, STEPS)))}', "measures")
    repeat_task, kit_task = section.text("repeat_task", ""), section.text("kit_task", "")
    if (repeat_task or kit_task) and not (groups or row_groups):
        section.error('"repeat_task" and "kit_task" need "groups" or "row_groups"')
    made = PrintedTable(
        section.name("id"),
        section.name("title"),
        columns,
        rows,
        decimals,
        section.name("section"),
        section.texts("settings", ()),
        section.texts("tasks", ()),
        cases,
        groups,
        row_groups,
        section.flag("seed_rows", False),
        measures,
        section.text("results_of", ""),
        repeat_task,
        kit_task,
        section.text("algorithm", "boltzmann-dqn"),
        0,
        section.text("steps_table", ""),
        section.text("run", ""),
        section.text("missing", ""),
        section.integer("seeds", 0, minimum=0),
        section.text("settings_of", "", choices=SOURCES) if section.has("settings_of") else "",
        section.flag("prints_best_test", False),
    )
    section.finish()
    return made


def _read_rows(
    section: Section, columns: Sequence[str], *, allow_empty: bool
) -> tuple[dict[str, tuple[float, ...]], tuple[int, ...]]:
    """The rows, and the most decimals of each column."""
    rows: dict[str, tuple[float, ...]] = {}
    decimals = [0] * len(columns)
    for row in section.texts("rows", at_least=1):
        label, _, rest = row.partition("|")
        words = rest.split()
        try:
            numbers = tuple(_cell_value(word, allow_empty=allow_empty) for word in words)
        except ValueError:
            numbers = ()
        if len(numbers) != len(columns):
            section.error(f"{quoted(row)} must be LABEL | {len(columns)} numbers", "rows")
            continue
        if label.strip() in rows:
            section.error(f"two rows are called {quoted(label.strip())}", "rows")
        rows[label.strip()] = numbers
        decimals = [
            max(most, len(word.partition(".")[2])) for most, word in zip(decimals, words, strict=True)
        ]
    return rows, tuple(decimals)


def _cell_value(word: str, *, allow_empty: bool) -> float:
    if word in _GROUP_LETTERS:
        return _GROUP_LETTERS[word]
    if word == EMPTY_CELL and allow_empty:
        return math.nan
    if not math.isfinite(number := float(word)):
        raise ValueError(word)
    return number


def _read_case(section: Section, text: str) -> tuple[str, str]:
    place, _, case = text.partition("/")
    if not place or not case:
        section.error(f"{quoted(text)} must be MAP/CASE")
    return place, case


def _read_figure(section: Section) -> PrintedFigure:
    made = PrintedFigure(
        section.name("id"),
        section.name("title"),
        section.name("section"),
        section.text("run", ""),
        section.texts("plots", ()),
        section.text("missing", ""),
        section.text("results_of", ""),
        section.text("group", ""),
        section.text("sessions", "", choices=SESSION_PLOTS),
        section.text("repeat_task", ""),
        section.integer("steps", 0, minimum=0),
        tuple(_read_case(section, each) for each in section.texts("paths", ())),
        section.integer("episodes", 0, minimum=0),
        section.texts("settings", ()),
    )
    if not (made.run or made.plots or made.missing):
        section.error('one of "run", "plots" and "missing" must say what the kit has for it')
    section.finish()
    return made


def read_misprint(section: Section, tables: Collection[PrintedTable]) -> Misprint:
    """``tables``: those in which it may lie."""
    known = {table.id: table for table in tables}
    cells = []
    table = known.get(section.text("table", choices=known))
    for each in section.sections("cells", ()):
        cell = MisprintCell(each.name("row"), each.name("column"), each.number("ours"))
        if table is not None and (cell.row not in table.rows or cell.column not in table.columns):
            each.error(f"Table {table.id} has no cell {quoted(cell.row)}, {quoted(cell.column)}")
        each.finish()
        cells.append(cell)
    made = Misprint(table.id if table else "", section.name("why"), tuple(cells))
    section.finish()
    return made

"""Shows layer plans: a case as a picture, the slides' method step by step, the fewest layers and why."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path
from typing import ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction, digits, letter
from kit.document.rows import Row, at_both_edges, in_columns, row, window
from kit.layers.case_sources import PlanningTask, UnknownPlanningTask, open_task, solve_task
from kit.layers.drawing.graph import MAX_ENTITIES_IN_PICTURE
from kit.layers.examples import EXAMPLES
from kit.layers.flatland.world_planning import WorldPlan
from kit.layers.guided_tour import GreedyTour, TourPart, case_page, method_pages, plan_pages
from kit.layers.guided_tour import TourPage as Step
from kit.layers.planning import LayerPlan
from kit.layers.requirements import LayerCase
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.layer_rows import layer_grid, picture, words_width
from kit.tui.rows.ruled_title import ruled_title
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.layer_case_editor import CaseEditor
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.theme import Theme
from kit.tui.widgets.text_field import KitInput
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.workspace import write_atomically
from kit.world.catalogue import map_names
from kit.world.problems import WorldError

PARTS: Final[tuple[TourPart, ...]] = ("case", "method", "fewest", "proof")

SIGNS: Final = (
    ("[ name ]", "in the layer of this step; its edges are thick"),
    ("C1 on an edge", "the layer that holds both its ends"),
    ("a dotted edge", "struck: some layer holds both its ends already"),
    ("# name #", "a map"),
    ("< name >", "a laser, with beams to all it must see"),
)

LEAST_PICTURE: Final = 30
"""Columns; with fewer the words take all."""

LEAST_WORDS: Final = 14
"""Rows of words; with fewer the grid of layers is left out."""
Solution = tuple[LayerPlan, WorldPlan | None]


class Solved(Message):
    """The planner is done with a task."""

    def __init__(self, task: PlanningTask, solution: Solution) -> None:
        super().__init__()
        self.task = task
        self.solution = solution


class LayersScreen(RowsScreen[None]):
    """Draws nothing but what a key has changed. ``saved_to``: the folder for cases that are saved."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "layers",
        ("page", "part", "other_edge", "edit", "choose_map", "save", "help", "back"),
        ("next", "previous", "scroll"),
        own=(
            ScreenAction("page", "left right", "page", "go to the previous or next page", (("left", "page(-1)"), ("right", "page(1)")), "arrows"),
            ScreenAction("part", "1 2 3 4", "part", "show the case, slides' method, fewest layers, proof", digits("part", 1, 4), "1-4"),
            letter("other_edge", "o", "edge", "change the edge that this step starts with"),
            letter("edit", "e", "edit", "change the case by hand"),
            ScreenAction("save", "Ctrl-S", "save", "save the requirements as a file for kit layers plan", (("ctrl+s", "save"),), "^S", has_priority=True),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    LayersScreen { layout: vertical; }
    LayersScreen #heading, LayersScreen #remark, LayersScreen #keys { height: 1; }
    LayersScreen #middle { height: 1fr; }
    LayersScreen #picture { width: 1fr; }
    LayersScreen Input, LayersScreen Input:focus { border: none; padding: 0; height: 1; background: transparent; }
    """

    def __init__(self, theme: Theme, task: PlanningTask, title: str, *, saved_to: Path) -> None:
        super().__init__()
        self._glyphs = theme.graph_glyphs
        self._folder = saved_to
        self._asked, self._title = task, title
        self._method = self._usual = GreedyTour(task.case)
        self._solution: Solution | None = None
        self._steps: tuple[Step, ...] = ()
        self._at = self._top = 0
        self._remark = row()

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield TextRows(id="picture")
            yield TextRows(id="words")
        yield TextRows(id="remark")
        yield TextRows(id="keys")
        yield KitInput(select_on_focus=False)

    def on_mount(self) -> None:
        self.query_one(Input).cursor_blink = False
        self._ask_for_name(False)
        self._start_solving()

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._lay_out)

    @property
    def step(self) -> Step | None:
        """The step of the plan that is shown."""
        return self._steps[self._at] if self._steps else None

    @property
    def is_solved(self) -> bool:
        """Whether the planner is done."""
        return self._solution is not None

    # The case and its plan

    def open(self, task: PlanningTask, title: str) -> None:
        """Another case, from its first page on."""
        self._asked, self._title = task, title
        self._method = self._usual = GreedyTour(task.case)
        self._solution = None
        self._at = self._top = 0
        self._remark = row()
        self._start_solving()
        self._lay_out()

    def _start_solving(self) -> None:
        """Has the planner at it, elsewhere: it may think for seconds."""
        task = self._asked

        def solve() -> None:
            self.post_message(Solved(task, solve_task(task)))

        threading.Thread(target=solve, name="planner", daemon=True).start()

    def on_solved(self, event: Solved) -> None:
        if event.task is self._asked:  # and not an earlier one's
            self._solution = event.solution
            self._lay_out()

    def _lay_out(self) -> None:
        """All pages for the present width; where one was stays as near as can be."""
        width = self._words_width - 1  # letters do not touch the screen's edge
        if not self.size.width:
            return
        case = self._asked.case
        if self._solution is None:
            waiting = ("Looking for the fewest layers ...",)
            rest: tuple[Step, ...] = (Step("fewest", "The fewest layers", waiting),)
        else:
            rest = tuple(plan_pages(case, *self._solution, self._usual.run, width))
        self._steps = (case_page(case, width), *method_pages(self._method.run, width), *rest)
        self._at = min(self._at, len(self._steps) - 1)
        self._show()

    # What is shown

    @property
    def _picture_width(self) -> int:
        room = self.size.width - words_width(self.size.width) - 1
        return room if room >= LEAST_PICTURE and len(self._asked.case.names) <= MAX_ENTITIES_IN_PICTURE else 0

    @property
    def _words_width(self) -> int:
        return words_width(self.size.width) if self._picture_width else self.size.width

    def _show(self) -> None:
        step = self.step
        if step is None:
            return
        rows = max(1, self.size.height - 3)
        beside = self._rows("picture")
        beside.display = bool(self._picture_width)
        if beside.display:
            beside.show(picture(self._asked.case, step, self._picture_width, rows, self._glyphs))
        self._rows("words").styles.width = self._words_width
        grid = layer_grid(self._asked.case, step, self._words_width, self._glyphs) if beside.display else []
        room = rows - len(grid) - 1
        if not grid or room < LEAST_WORDS:
            room, grid = rows, []
        words, self._top = window([row(line) for line in step.lines], self._top, room)
        left = rows - len(words) - len(grid)
        asked = self._asked_rows(self._words_width - 1, left) if grid and step.part != "case" else []
        space = [row() for _ in range(left - len(asked))]
        self._rows("words").show([*words, *space, *asked, *grid])
        self._rows("heading").show([self._heading(step)])
        self._rows("remark").show([self._remark])
        self._rows("keys").show(
            [footer(self.screen_actions, self.size.width, labels={"choose_map": "cases"})]
        )

    def _asked_rows(self, width: int, room: int) -> list[Row]:
        """What is asked, above the grid and as many rows on each page, so that it stays where it is; nothing where it has no room
        on this one."""
        case, columns = self._steps[0], width // 2
        placed = in_columns(
            lambda column: [[row(line)] for line in self._case_lines(column - 1)], width, 1, columns
        )
        rows = [ruled_title(case.title.lower(), width), *placed, row()]
        return rows if len(rows) < room else []

    def _case_lines(self, width: int) -> tuple[str, ...]:
        return case_page(self._asked.case, width).lines

    def _heading(self, step: Step) -> Row:
        number = PARTS.index(step.part) + 1
        left = row((self._title, "title"), f"  {number}. {step.title}")
        place = row((f"{self._at + 1} of {len(self._steps)}", "dim"))
        return at_both_edges(left, place, self.size.width)

    # Keys

    def action_page(self, steps: int) -> None:
        self._turn_to(min(max(self._at + steps, 0), len(self._steps) - 1))

    def action_next(self) -> None:
        self.action_page(1)

    def action_previous(self) -> None:
        self.action_page(-1)

    def action_part(self, number: int) -> None:
        part = PARTS[number - 1]
        self._turn_to(next((i for i, step in enumerate(self._steps) if step.part == part), self._at))

    def _turn_to(self, at: int) -> None:
        if at != self._at:
            self._at, self._top, self._remark = at, 0, row()
            self._show()

    def action_scroll(self, lines: int) -> None:
        self._top += lines
        self._show()

    def action_other_edge(self) -> None:
        step = self.step
        if step is None or step.step is None:
            self._show_remark(
                "the method chooses an edge where it begins a layer: press 2, then right", "warn"
            )
            return
        number = step.step
        edges = {str(edge): edge for edge in self._method.edges(number)}
        taken = str(self._method.run.collision_steps[number].edge)
        choices = [PickerItem(name, name, "the present one" if name == taken else "") for name in edges]

        def begin_with(chosen: str | None) -> None:
            if chosen is not None:
                self._method = self._method.with_edge(number, edges[chosen])
                self._lay_out()
                self._show_remark(
                    f"The method starts this layer with that edge and ends with {self._method.run.size} layers."
                )

        self.app.push_screen(Picker("Start this layer with", choices, taken), begin_with)

    def action_edit(self) -> None:
        self.app.push_screen(CaseEditor(self._asked.case, self._glyphs), self._on_case_edited)

    def _on_case_edited(self, case: LayerCase | None) -> None:
        if case is not None and case != self._asked.case:
            is_new = self._title in EXAMPLES  # and so is what it is about
            self.open(
                PlanningTask(replace(case, title="") if is_new else case), "mine" if is_new else self._title
            )

    def action_choose_map(self) -> None:
        choices = [PickerItem(name, name, case.title) for name, case in EXAMPLES.items()]
        choices += [
            PickerItem(name, name, "a map of the kit") for name in map_names() if name not in EXAMPLES
        ]
        self.app.push_screen(Picker("Cases", choices), self._open_named)

    def _open_named(self, name: str | None) -> None:
        if name is None:
            return
        try:
            self.open(open_task(name), name)
        except (WorldError, UnknownPlanningTask) as error:
            self.app.push_screen(MessageDialog("That did not work", str(error)))

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        # Before all others, so that letters that come with it reach the field; in the field it is a letter itself.
        return action != "save" or (self.is_mounted and self.focused is None)

    def action_save(self) -> None:
        self._ask_for_name(True)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        name = event.value.strip()
        if self.focused is None:
            return  # a second Enter that came with the first
        self._ask_for_name(False)
        if name:
            self._save(self._folder / f"{Path(name).name}.layers.yaml")

    def _save(self, file: Path) -> None:
        if file.exists():
            self._show_remark(f"{file.name} already exists: choose another name", "bad")
            return
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(file, self._asked.as_requirements().encode())
        except OSError as error:
            self._show_remark(f"{file}: cannot be written: {error.strerror}", "bad")
        else:
            self._show_remark(f"written: kit layers plan {file}", "good")

    def _show_remark(self, text: str, style: str = "") -> None:
        self._remark = row((text, style))
        self._rows("remark").show([self._remark])

    def _ask_for_name(self, asked: bool) -> None:
        """The field in place of the keys, or the keys. At once: the next letters may be here already."""
        field = self.query_one(Input)
        field.value = ""
        field.placeholder = f"name of the file in {self._folder}; Enter saves, Esc goes back"
        field.display, self._rows("keys").display = asked, not asked
        self.set_focus(field if asked else None)

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Layers", self.screen_actions, SIGNS))

    def action_back(self) -> None:
        if self.focused is not None:
            self._ask_for_name(False)
        elif len(self.app.screen_stack) > 2:
            self.dismiss()
        else:
            self.app.exit()

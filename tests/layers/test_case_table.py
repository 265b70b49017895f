"""A case typed by hand: whatever is typed is a case, can be undone, and reads back as it was."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.layers.case_table import CaseTable, RowKind
from kit.layers.examples import EXAMPLES
from kit.layers.requirements import ContactRequirement, LayerCase, LayerCaseError, SightRequirement
from kit.layers.requirements_file import read_requirements, requirements_text
from tests.cases import every_case

EMPTY = CaseTable(LayerCase(()))


def typed(*names: tuple[RowKind, str]) -> CaseTable:
    editing = EMPTY
    for kind, name in names:
        editing = editing.with_row_added(kind, name)
    return editing


ROOM = typed(("map", "walls"), ("body", "robot"), ("laser", "eye"))


def test_the_smallest_case_from_nothing() -> None:
    editing = ROOM.with_cursor_moved(-1, -5).with_mark_toggled()
    assert editing.cell_text == "walls and robot must collide"
    editing = editing.with_cursor_moved(1, 0).with_mark_toggled()
    assert editing.cell_text == "eye must see walls"
    assert editing.case.requirements == (
        ContactRequirement("walls", "robot"),
        SightRequirement("eye", "walls"),
    )


def test_a_mark_turns_through_all_three_and_back() -> None:
    pair = ROOM.with_cursor_moved(-1, -5)
    said = []
    for _ in range(4):
        said.append(pair.cell_text.removeprefix("walls and robot "))
        pair = pair.with_mark_toggled()
    assert said == ["must not collide", "must collide", "may share a layer", "must not collide"]
    sight = ROOM.with_cursor_moved(0, 1)
    said = []
    for _ in range(4):
        said.append(sight.cell_text)
        sight = sight.with_mark_toggled()
    assert said == [
        "eye must not see robot",
        "eye must see robot",
        "eye may see robot",
        "eye must not see robot",
    ]


def test_the_cursor_stays_in_the_table() -> None:
    assert (ROOM.row, ROOM.column) == (2, 0)
    assert ROOM.with_cursor_moved(0, 9).column == 1
    assert ROOM.with_cursor_moved(9, 0).row == 2
    assert ROOM.with_cursor_moved(0, 1).with_cursor_moved(-2, 0).column == 0
    assert EMPTY.with_cursor_moved(1, 1) == EMPTY
    assert EMPTY.cell_text == "there is no entity yet"


@every_case("key", ["two maps", "itself", "no name", "a space", "twice", "a part of a whole", "nothing"])
def test_what_cannot_be_is_refused_with_a_reason(key: str) -> None:
    two_maps = typed(("map", "walls"), ("map", "floor")).with_cursor_moved(0, -1)
    refused = {
        "two maps": two_maps.with_mark_toggled,
        "itself": typed(("body", "robot")).with_mark_toggled,
        "no name": lambda: ROOM.with_row_added("body", ""),
        "a space": lambda: ROOM.with_row_added("body", "my robot"),
        "twice": lambda: ROOM.with_row_added("map", "robot"),
        "a part of a whole": lambda: ROOM.with_row_added("body", "robot.arm"),
        "nothing": EMPTY.with_row_removed,
    }
    with pytest.raises(LayerCaseError) as caught:
        refused[key]()
    assert str(caught.value)


def test_a_row_is_deleted_with_all_that_is_said_of_it() -> None:
    editing = ROOM.with_cursor_moved(-1, 0).with_mark_toggled().with_cursor_moved(1, 0).with_mark_toggled()
    without_map = editing.with_cursor_moved(-2, 0).with_row_removed()
    assert without_map.case.names == ("robot",)
    assert without_map.case.requirements == ()
    without_laser = editing.with_row_removed()
    assert without_laser.case.lasers == ()
    assert without_laser.case.names == ("walls", "robot")


def test_every_change_can_be_undone() -> None:
    steps = [EMPTY]
    for change in (
        lambda editing: editing.with_row_added("map", "walls"),
        lambda editing: editing.with_row_added("body", "robot"),
        lambda editing: editing.with_mark_toggled(),
        lambda editing: editing.with_row_added("laser", "eye"),
        lambda editing: editing.with_row_removed(),
    ):
        steps.append(change(steps[-1].with_cursor_moved(0, -5)))
    editing = steps[-1]
    for before in reversed(steps[:-1]):
        editing = editing.undo()
        assert editing.case == before.case
    with pytest.raises(LayerCaseError):
        editing.undo()


def test_parts_of_one_model_are_free_by_assumption_and_not_by_themselves() -> None:
    editing = typed(("body", "cart.front"), ("body", "cart.back"))
    assert editing.case.relation("cart.front", "cart.back") == "apart"
    free = CaseTable(editing.written_case, row=1, ignore_self_collisions=True)
    assert free.case.relation("cart.front", "cart.back") == "either"
    with pytest.raises(LayerCaseError):
        free.with_mark_toggled()


KEYS: dict[str, Callable[[CaseTable, int], CaseTable]] = {
    "up": lambda editing, number: editing.with_cursor_moved(-1, 0),
    "down": lambda editing, number: editing.with_cursor_moved(1, 0),
    "left": lambda editing, number: editing.with_cursor_moved(0, -1),
    "right": lambda editing, number: editing.with_cursor_moved(0, 1),
    "turn": lambda editing, number: editing.with_mark_toggled(),
    "map": lambda editing, number: editing.with_row_added("map", f"map{number}"),
    "body": lambda editing, number: editing.with_row_added("body", f"body{number}"),
    "part": lambda editing, number: editing.with_row_added("body", f"cart.part{number}"),
    "laser": lambda editing, number: editing.with_row_added("laser", f"laser{number}"),
    "delete": lambda editing, number: editing.with_row_removed(),
    "undo": lambda editing, number: editing.undo(),
}


@given(st.lists(st.sampled_from(list(KEYS)), max_size=60))
def test_whatever_is_typed_is_a_case_that_reads_back(keys: list[str]) -> None:
    editing = EMPTY
    for number, key in enumerate(keys):
        try:
            editing = KEYS[key](editing, number)
        except LayerCaseError:
            continue
        assert 0 <= editing.row < max(1, editing.rows)
        assert editing.cell_text
    if editing.case.entities:
        assert_reads_back(editing.case)


def assert_reads_back(case: LayerCase) -> None:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "case.layers.yaml"
        file.write_text(requirements_text(case))
        read = read_requirements(file).case
    assert set(read.names) == set(case.names)
    assert set(read.requirements) == set(case.requirements)
    assert read.either == case.either


@every_case("name", EXAMPLES)
def test_an_example_can_be_edited(name: str) -> None:
    editing = CaseTable(EXAMPLES[name], row=1)
    assert editing.with_row_added("body", "newcomer").undo().case == EXAMPLES[name]

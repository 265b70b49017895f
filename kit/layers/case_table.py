"""A case built by hand: a table with a cursor, every change a new value, every change undone."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final, Literal

from kit.layers.requirements import LaserEntity, LayerCase, LayerCaseError, LayerEntity, Relation, Sighting

NEXT_RELATION: Final[Mapping[Relation, Relation]] = MappingProxyType(
    {"apart": "collide", "collide": "either", "either": "apart"}
)
NEXT_SIGHTING: Final[Mapping[Sighting, Sighting]] = MappingProxyType(
    {"blind": "sees", "sees": "either", "either": "blind"}
)
_NAME_PATTERN: Final = re.compile(r"[^\W\d][\w-]*(\.[\w-]+)*")

RowKind = Literal["map", "body", "laser"]


@dataclass(frozen=True)
class CaseTable:
    """A case, its rows (entities, then lasers) and a cursor on one mark. Methods return the changed value; they
    raise LayerCaseError, with the reason, for what cannot be."""

    written_case: LayerCase
    """The case as written in a file."""
    row: int = 0
    column: int = 0
    ignore_self_collisions: bool = False
    """Whether bodies of one model are assumed never to collide, as in the slides."""
    history: tuple[LayerCase, ...] = ()
    """Earlier cases for undo, the newest last."""

    @property
    def case(self) -> LayerCase:
        return (
            self.written_case.without_self_collisions() if self.ignore_self_collisions else self.written_case
        )

    @property
    def rows(self) -> int:
        return len(self.written_case.entities) + len(self.written_case.lasers)

    @property
    def laser(self) -> LaserEntity | None:
        """The laser whose row the cursor is in."""
        number = self.row - len(self.written_case.entities)
        return self.written_case.lasers[number] if 0 <= number < len(self.written_case.lasers) else None

    @property
    def cell_names(self) -> tuple[str, str] | None:
        """Returns the names of the cursor's cell: two entities in their order, or a laser and an entity."""
        names = self.written_case.names
        if not names:
            return None
        column = names[self.column]
        return (column, names[self.row]) if self.laser is None else (self.laser.name, column)

    @property
    def cell_text(self) -> str:
        """The cursor's mark in words."""
        pair = self.cell_names
        if pair is None:
            return "there is no entity yet"
        one, other = pair
        if self.laser is not None:
            return {
                "sees": f"{one} must see {other}",
                "either": f"{one} may see {other}",
                "blind": f"{one} must not see {other}",
            }[self.case.laser[one].sighting(other)]
        if one == other:
            return one
        return {
            "collide": f"{one} and {other} must collide",
            "either": f"{one} and {other} may share a layer",
            "apart": f"{one} and {other} must not collide",
        }[self.case.relation(one, other)]

    def with_cursor_moved(self, down: int, right: int) -> CaseTable:
        """The table with the cursor moved, within its rows and columns."""
        row = min(max(self.row + down, 0), max(0, self.rows - 1))
        count = len(self.written_case.entities)
        last = min(row, count - 1) if row < count else count - 1
        return replace(self, row=row, column=min(max(self.column + right, 0), max(0, last)))

    def with_mark_toggled(self) -> CaseTable:
        """The cursor's mark changed to the next of its three."""
        pair = self.cell_names
        if pair is None:
            raise LayerCaseError("add a map or a body first")
        one, other = pair
        if self.laser is not None:
            new = NEXT_SIGHTING[self.written_case.laser[one].sighting(other)]
            return self._with_case(self.written_case.with_sighting(one, other, new))
        if one == other and self.written_case.by_name[one].copies == 1:
            raise LayerCaseError(f"there is only one {one}: move the cursor to another column")
        if self.case.relation(one, other) != self.written_case.relation(one, other):
            raise LayerCaseError("bodies of one model never meet, as long as this is assumed")
        return self._with_case(
            self.written_case.with_relation(one, other, NEXT_RELATION[self.written_case.relation(one, other)])
        )

    def with_row_added(self, kind: RowKind, name: str) -> CaseTable:
        """The table with one more entity or laser, which has contact with none, and the cursor in its row."""
        if not _NAME_PATTERN.fullmatch(name):
            raise LayerCaseError(
                f"{name!r}: a name is letters, digits, _ and -; MODEL.PART for a part of a model"
            )
        if kind == "laser":
            new = self._with_case(self.written_case.with_laser(LaserEntity(name)))
            return replace(new, row=new.rows - 1).with_cursor_moved(0, 0)
        model = name.partition(".")[0] if kind == "body" else ""
        parts = [other.name for other in self.written_case.entities if model and other.model == model]
        if any((model == other) != (model == name) for other in parts) or (parts and model == name):
            raise LayerCaseError(
                f"{model} is either one body or has parts: {', '.join(parts)} is here already"
            )
        entity = LayerEntity(name, kind="map" if kind == "map" else "bodies", model=model)
        new = self._with_case(self.written_case.with_entity(entity))
        return replace(new, row=len(new.written_case.entities) - 1).with_cursor_moved(0, 0)

    def with_row_removed(self) -> CaseTable:
        """The cursor's entity or laser gone, with everything said about it."""
        if not self.rows:
            raise LayerCaseError("there is no entity or laser to remove")
        laser = self.laser
        gone = (
            self.written_case.without_entity(self.written_case.names[self.row])
            if laser is None
            else self.written_case.without_laser(laser.name)
        )
        return self._with_case(gone).with_cursor_moved(0, 0)

    def undo(self) -> CaseTable:
        """Returns the table before the last change."""
        if not self.history:
            raise LayerCaseError("there is nothing to undo")
        return replace(self, written_case=self.history[-1], history=self.history[:-1]).with_cursor_moved(0, 0)

    def _with_case(self, case: LayerCase) -> CaseTable:
        return replace(self, written_case=case, history=(*self.history, self.written_case))

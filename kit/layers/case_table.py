"""A case built by hand: a table with a cursor, every change a new value, every change undone."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final, Literal

from kit.layers.requirements import Case, CaseError, Entity, Laser, Relation, Sighting

NEXT_RELATION: Final[Mapping[Relation, Relation]] = MappingProxyType(
    {"apart": "collide", "collide": "either", "either": "apart"}
)
NEXT_SIGHTING: Final[Mapping[Sighting, Sighting]] = MappingProxyType(
    {"blind": "sees", "sees": "either", "either": "blind"}
)
_NAME: Final = re.compile(r"[^\W\d][\w-]*(\.[\w-]+)*")

Kind = Literal["map", "body", "laser"]


@dataclass(frozen=True)
class Editing:
    """A case, its rows (entities, then lasers) and a cursor on one mark. Methods return the changed value; they
    raise CaseError, with the reason, for what cannot be."""

    written: Case
    """As it is written down."""
    row: int = 0
    column: int = 0
    never: bool = False
    """Whether bodies of one model are assumed never to meet, as the slides do."""
    before: tuple[Case, ...] = ()
    """What can be gone back to, the newest last."""

    @property
    def case(self) -> Case:
        return self.written.with_one_model_free() if self.never else self.written

    @property
    def rows(self) -> int:
        return len(self.written.entities) + len(self.written.lasers)

    @property
    def laser(self) -> Laser | None:
        """The laser whose row the cursor is in."""
        number = self.row - len(self.written.entities)
        return self.written.lasers[number] if 0 <= number < len(self.written.lasers) else None

    @property
    def pair(self) -> tuple[str, str] | None:
        """What the cursor's mark is about: two entities in their order, or a laser and an entity."""
        names = self.written.names
        if not names:
            return None
        column = names[self.column]
        return (column, names[self.row]) if self.laser is None else (self.laser.name, column)

    @property
    def meaning(self) -> str:
        """The cursor's mark in words."""
        pair = self.pair
        if pair is None:
            return "nobody is here yet"
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

    def moved(self, down: int, right: int) -> Editing:
        """The cursor elsewhere, within the table."""
        row = min(max(self.row + down, 0), max(0, self.rows - 1))
        count = len(self.written.entities)
        last = min(row, count - 1) if row < count else count - 1
        return replace(self, row=row, column=min(max(self.column + right, 0), max(0, last)))

    def turned(self) -> Editing:
        """The cursor's mark changed to the next of its three."""
        pair = self.pair
        if pair is None:
            raise CaseError("add a map or a body first")
        one, other = pair
        if self.laser is not None:
            new = NEXT_SIGHTING[self.written.laser[one].sighting(other)]
            return self._changed(self.written.with_sighting(one, other, new))
        if one == other and self.written.by_name[one].copies == 1:
            raise CaseError(f"there is only one {one}: move the cursor to another column")
        if self.case.relation(one, other) != self.written.relation(one, other):
            raise CaseError("bodies of one model never meet, as long as this is assumed")
        return self._changed(
            self.written.with_relation(one, other, NEXT_RELATION[self.written.relation(one, other)])
        )

    def with_new(self, kind: Kind, name: str) -> Editing:
        """Another entity or laser, apart from all others, and the cursor in its row."""
        if not _NAME.fullmatch(name):
            raise CaseError(f"{name!r}: a name is letters, digits, _ and -; MODEL.PART for a part of a model")
        if kind == "laser":
            new = self._changed(self.written.with_laser(Laser(name)))
            return replace(new, row=new.rows - 1).moved(0, 0)
        model = name.partition(".")[0] if kind == "body" else ""
        parts = [other.name for other in self.written.entities if model and other.model == model]
        if any((model == other) != (model == name) for other in parts) or (parts and model == name):
            raise CaseError(f"{model} is either one body or has parts: {', '.join(parts)} is here already")
        entity = Entity(name, kind="map" if kind == "map" else "bodies", model=model)
        new = self._changed(self.written.with_entity(entity))
        return replace(new, row=len(new.written.entities) - 1).moved(0, 0)

    def without_row(self) -> Editing:
        """The cursor's entity or laser gone, with everything said about it."""
        if not self.rows:
            raise CaseError("nobody is here")
        laser = self.laser
        gone = (
            self.written.without_entity(self.written.names[self.row])
            if laser is None
            else self.written.without_laser(laser.name)
        )
        return self._changed(gone).moved(0, 0)

    def undone(self) -> Editing:
        """As before the last change."""
        if not self.before:
            raise CaseError("there is nothing to undo")
        return replace(self, written=self.before[-1], before=self.before[:-1]).moved(0, 0)

    def _changed(self, case: Case) -> Editing:
        return replace(self, written=case, before=(*self.before, self.written))

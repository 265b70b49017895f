"""The assignment of layers as tables."""

from __future__ import annotations

from collections.abc import Sequence

from kit.document.blocks import CellStyle, Column, Table
from kit.layers.assignment import LayerAssignment
from kit.layers.requirements import LayerCase


def assignment_tables(case: LayerCase, assignment: LayerAssignment) -> list[Table]:
    """The plan: what each layer holds and who watches it; which list each entity and laser gets."""
    watchers = {
        layer.name: ", ".join(name for name, watched in assignment.watches.items() if layer.name in watched)
        for layer in assignment.layers
    }
    in_order = {name: i for i, name in enumerate(case.names)}
    layers = [
        (
            layer.name,
            ", ".join(sorted(layer.members, key=lambda n: in_order.get(n, -1))),
            watchers[layer.name] or "-",
        )
        for layer in assignment.layers
    ]
    none = "(none: layers: [])"
    lists = [(name, ", ".join(assignment.layers_of(name)) or none) for name in case.names]
    lasers = [(name, ", ".join(assignment.watches.get(name, ())) or none) for name in case.laser]
    tables = [
        _text_table(("layer", "holds", "watched by"), layers),
        _text_table(("who", "its layers"), lists),
        _text_table(("laser", "watches"), lasers),
    ]
    return [each for each in tables if each.rows or each is not tables[-1]]


def _text_table(heads: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> Table:
    columns = tuple(Column(head, CellStyle.TEXT) for head in heads)
    return Table("assignment", "", columns, tuple(rows), is_ruled=False)

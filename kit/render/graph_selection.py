"""Which element of a drawn graph is selected, and where the arrow keys lead from it."""

from __future__ import annotations

from kit.render.graph_drawing import ColumnName, GraphDrawing, GraphElement, GraphLink

_COLUMNS: tuple[ColumnName, ...] = ("sender", "item", "receiver")


def initial_selection(drawing: GraphDrawing) -> GraphElement | None:
    """Returns the first selection: an item with a mismatch, else the topmost topic, else a node."""
    mismatched = [GraphElement("item", item.label) for item in drawing.graph.items if item.undelivered]
    rows = drawing.element_rows()
    return min(
        mismatched or rows, key=lambda element: (element.column != "item", rows[element]), default=None
    )


def kept_selection(drawing: GraphDrawing, selected: GraphElement | None, row: int) -> GraphElement | None:
    """Returns the same element, or the one nearest to its row if it is gone."""
    rows = drawing.element_rows()
    if selected is None or not rows:
        return initial_selection(drawing)
    if selected in rows:
        return selected
    return min(rows, key=lambda other: (other.column != selected.column, abs(rows[other] - row)))


def move_vertically(drawing: GraphDrawing, selected: GraphElement, steps: int) -> GraphElement:
    """Returns the element ``steps`` further down its column, or up."""
    rows = drawing.element_rows()
    column = sorted(
        (other for other in rows if other.column == selected.column), key=lambda other: rows[other]
    )
    return column[min(max(column.index(selected) + steps, 0), len(column) - 1)]


def move_horizontally(drawing: GraphDrawing, selected: GraphElement, steps: int) -> GraphElement:
    """One column to the right, or left: along a line if there is one, to the nearest row."""
    number = _COLUMNS.index(selected.column) + steps
    if not 0 <= number < len(_COLUMNS):
        return selected
    rows = drawing.element_rows()
    beside = [other for other in rows if other.column == _COLUMNS[number]]
    if not beside:
        return selected
    return min(
        beside,
        key=lambda other: (not _are_linked(drawing, selected, other), abs(rows[other] - rows[selected])),
    )


def _are_linked(drawing: GraphDrawing, one: GraphElement, other: GraphElement) -> bool:
    node, item = (other, one) if one.column == "item" else (one, other)
    return GraphLink(node.name, item.name, is_sender=node.column == "sender") in drawing.routes

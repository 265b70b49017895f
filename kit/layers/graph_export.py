"""The collision graph as text for Graphviz and for Mermaid, with the layers of a plan if there is one."""

from __future__ import annotations

from kit.layers.assignment import LayerAssignment
from kit.layers.requirements import ContactRequirement, LayerCase


def graphviz_text(case: LayerCase, assignment: LayerAssignment | None = None) -> str:
    """The graph in Graphviz's language: ``dot -Tsvg`` or ``neato -Tpng`` draws it.

    Required contacts are solid lines, pairs that may share a layer dashed ones; a laser is a triangle with an
    arrow to everything it must see. Lines and names carry the layers of the assignment.
    """
    lines = ["graph layers {", "  layout=neato; overlap=false; splines=true;", "  node [fontname=sans];"]
    for entity in case.entities:
        shape = "box" if entity.kind == "map" else "ellipse"
        lines.append(
            f"  {_quote_dot(entity.name)} [shape={shape}{_label_attribute(_entity_label(entity.name, assignment))}];"
        )
    lines.extend(
        f"  {_edge_text(contact)} [style=solid{_label_attribute(_shared_label(contact, assignment))}];"
        for contact in case.collide
    )
    lines.extend(f"  {_edge_text(contact)} [style=dashed, color=gray];" for contact in sorted(case.either))
    for laser in case.lasers:
        watched = () if assignment is None else assignment.watches.get(laser.name, ())
        lines.append(
            f"  {_quote_dot(laser.name)} [shape=triangle{_label_attribute(_with_layers(laser.name, watched))}];"
        )
        lines.extend(
            f"  {_quote_dot(laser.name)} -- {_quote_dot(name)} [dir=forward, color=red];"
            for name in case.names
            if name in laser.sees
        )
    return "\n".join([*lines, "}", ""])


def mermaid_text(case: LayerCase, assignment: LayerAssignment | None = None) -> str:
    """The graph in Mermaid's language, which GitHub and GitLab draw inside Markdown."""
    ids = {name: f"e{i}" for i, name in enumerate(case.names)}
    lasers = {laser.name: f"l{i}" for i, laser in enumerate(case.lasers)}
    lines = ["graph LR"]
    for entity in case.entities:
        left, right = ("[", "]") if entity.kind == "map" else ("([", "])")
        label = _escape_mermaid(_entity_label(entity.name, assignment) or entity.name)
        lines.append(f'  {ids[entity.name]}{left}"{label}"{right}')
    for contact in case.collide:
        shared = ", ".join(_layers_shared(contact, assignment))
        label = f"|{_escape_mermaid(shared)}|" if shared else ""
        lines.append(f"  {ids[contact.a]} ---{label} {ids[contact.b]}")
    lines.extend(f"  {ids[contact.a]} -.- {ids[contact.b]}" for contact in sorted(case.either))
    for laser in case.lasers:
        watched = () if assignment is None else assignment.watches.get(laser.name, ())
        lines.append(f'  {lasers[laser.name]}{{{{"{_escape_mermaid(_with_layers(laser.name, watched))}"}}}}')
        lines.extend(f"  {lasers[laser.name]} ==> {ids[name]}" for name in case.names if name in laser.sees)
    return "\n".join([*lines, ""])


def _with_layers(name: str, layers: tuple[str, ...]) -> str:
    return f"{name}: {', '.join(layers)}" if layers else name


def _entity_label(name: str, assignment: LayerAssignment | None) -> str:
    return "" if assignment is None else _with_layers(name, assignment.layers_of(name))


def _layers_shared(contact: ContactRequirement, assignment: LayerAssignment | None) -> tuple[str, ...]:
    if assignment is None:
        return ()
    other = assignment.layers_of(contact.b)
    return tuple(name for name in assignment.layers_of(contact.a) if name in other)


def _shared_label(contact: ContactRequirement, assignment: LayerAssignment | None) -> str:
    return ", ".join(_layers_shared(contact, assignment))


def _edge_text(contact: ContactRequirement) -> str:
    return f"{_quote_dot(contact.a)} -- {_quote_dot(contact.b)}"


def _quote_dot(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def _label_attribute(text: str) -> str:
    return f", label={_quote_dot(text)}" if text else ""


def _escape_mermaid(text: str) -> str:
    """Text that Mermaid takes for text, whatever it holds."""
    return "".join(c if c.isalnum() or c in " .,:_-" else f"#{ord(c)};" for c in text)

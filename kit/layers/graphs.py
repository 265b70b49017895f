"""The collision graph as text for Graphviz and for Mermaid, with the layers of a plan if there is one."""

from __future__ import annotations

from kit.layers.assignment import Assignment
from kit.layers.requirements import Case, Contact


def graphviz(case: Case, assignment: Assignment | None = None) -> str:
    """The graph in Graphviz's language: ``dot -Tsvg`` or ``neato -Tpng`` draws it.

    Required contacts are solid lines, pairs that may share a layer dashed ones; a laser is a triangle with an
    arrow to everything it must see. Lines and names carry the layers of the assignment.
    """
    lines = ["graph layers {", "  layout=neato; overlap=false; splines=true;", "  node [fontname=sans];"]
    for entity in case.entities:
        shape = "box" if entity.kind == "map" else "ellipse"
        lines.append(f"  {_quoted(entity.name)} [shape={shape}{_label(_listed(entity.name, assignment))}];")
    lines.extend(
        f"  {_edge(contact)} [style=solid{_label(_shared(contact, assignment))}];" for contact in case.collide
    )
    lines.extend(f"  {_edge(contact)} [style=dashed, color=gray];" for contact in sorted(case.either))
    for laser in case.lasers:
        watched = () if assignment is None else assignment.watches.get(laser.name, ())
        lines.append(f"  {_quoted(laser.name)} [shape=triangle{_label(_with(laser.name, watched))}];")
        lines.extend(
            f"  {_quoted(laser.name)} -- {_quoted(name)} [dir=forward, color=red];"
            for name in case.names
            if name in laser.sees
        )
    return "\n".join([*lines, "}", ""])


def mermaid(case: Case, assignment: Assignment | None = None) -> str:
    """The graph in Mermaid's language, which GitHub and GitLab draw inside Markdown."""
    ids = {name: f"e{i}" for i, name in enumerate(case.names)}
    lasers = {laser.name: f"l{i}" for i, laser in enumerate(case.lasers)}
    lines = ["graph LR"]
    for entity in case.entities:
        left, right = ("[", "]") if entity.kind == "map" else ("([", "])")
        label = _mermaid_text(_listed(entity.name, assignment) or entity.name)
        lines.append(f'  {ids[entity.name]}{left}"{label}"{right}')
    for contact in case.collide:
        shared = ", ".join(_layers_shared(contact, assignment))
        label = f"|{_mermaid_text(shared)}|" if shared else ""
        lines.append(f"  {ids[contact.a]} ---{label} {ids[contact.b]}")
    lines.extend(f"  {ids[contact.a]} -.- {ids[contact.b]}" for contact in sorted(case.either))
    for laser in case.lasers:
        watched = () if assignment is None else assignment.watches.get(laser.name, ())
        lines.append(f'  {lasers[laser.name]}{{{{"{_mermaid_text(_with(laser.name, watched))}"}}}}')
        lines.extend(f"  {lasers[laser.name]} ==> {ids[name]}" for name in case.names if name in laser.sees)
    return "\n".join([*lines, ""])


def _with(name: str, layers: tuple[str, ...]) -> str:
    return f"{name}: {', '.join(layers)}" if layers else name


def _listed(name: str, assignment: Assignment | None) -> str:
    return "" if assignment is None else _with(name, assignment.layers_of(name))


def _layers_shared(contact: Contact, assignment: Assignment | None) -> tuple[str, ...]:
    if assignment is None:
        return ()
    other = assignment.layers_of(contact.b)
    return tuple(name for name in assignment.layers_of(contact.a) if name in other)


def _shared(contact: Contact, assignment: Assignment | None) -> str:
    return ", ".join(_layers_shared(contact, assignment))


def _edge(contact: Contact) -> str:
    return f"{_quoted(contact.a)} -- {_quoted(contact.b)}"


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def _label(text: str) -> str:
    return f", label={_quoted(text)}" if text else ""


def _mermaid_text(text: str) -> str:
    """Text that Mermaid takes for text, whatever it holds."""
    return "".join(c if c.isalnum() or c in " .,:_-" else f"#{ord(c)};" for c in text)

"""Plans as data, under names that stay: for ``--json`` the facts of the text, for Graphviz and Mermaid the collision graph."""

from __future__ import annotations

from typing import Any

from kit.layers.assignment import LayerAssignment, RequirementBreach
from kit.layers.bound_certificates import BoundCertificate
from kit.layers.flatland.world_patch import WorldPatch
from kit.layers.flatland.world_planning import WorldPlan
from kit.layers.greedy import GreedyRun
from kit.layers.planning import LayerPlan
from kit.layers.relaxations import Relaxation
from kit.layers.requirements import ContactRequirement, LayerCase, Requirement, SightRequirement
from kit.world.records import MAX_LAYERS


def assignment_data(case: LayerCase, assignment: LayerAssignment) -> dict[str, Any]:
    """Layers with their members and watchers, and the list of every entity and laser."""
    return {
        "layers": [
            {
                "name": layer.name,
                "holds": [name for name in case.names if name in layer.members],
                "watched_by": [name for name in case.laser if layer.name in assignment.watches.get(name, ())],
            }
            for layer in assignment.layers
        ],
        "entities": [
            {"name": entity.name, "kind": entity.kind, "layers": list(assignment.layers_of(entity.name))}
            for entity in case.entities
        ],
        "lasers": [{"name": name, "watches": list(assignment.watches.get(name, ()))} for name in case.laser],
    }


def plan_data(plan: LayerPlan, run: GreedyRun) -> dict[str, Any]:
    """A plan of requirements, with its proof and the slides' method beside it."""
    return {
        "title": plan.case.title,
        "size": plan.size,
        "bound": plan.bound,
        "optimal": plan.is_optimal,
        "fits_flatland": plan.size <= MAX_LAYERS,
        **assignment_data(plan.case, plan.assignment),
        "certificate": certificate_data(plan.certificate),
        "slides_method": {"size": run.size, "unseen": [requirement_data(sight) for sight in run.missed]},
        "seconds": round(plan.seconds, 6),
    }


def greedy_data(run: GreedyRun) -> dict[str, Any]:
    """The result of the slides' method."""
    unseen = [requirement_data(sight) for sight in run.missed]
    return {"size": run.size, "unseen": unseen, **assignment_data(run.case, run.assignment)}


def world_data(plan: WorldPlan) -> dict[str, Any]:
    """A plan for a world: with the world's own names, and what is wrong at present."""
    return {
        "size": plan.size,
        "bound": plan.bound,
        "optimal": plan.is_optimal,
        "fits_flatland": plan.size <= MAX_LAYERS,
        "world": str(plan.world_case.layer_lists.world.file),
        "names_today": plan.current_name_count,
        "kept": list(plan.world_case.layer_lists.kept_layers),
        "breaches_today": [breach_data(breach) for breach in plan.current_breaches],
        **assignment_data(plan.world_case.case, plan.assignment),
    }


def check_data(plan: WorldPlan) -> dict[str, Any]:
    """The verdict on a world as it is."""
    return {
        "world": str(plan.world_case.layer_lists.world.file),
        "names_today": plan.current_name_count,
        "needed": plan.size,
        "bound": plan.bound,
        "breaches": [breach_data(breach) for breach in plan.current_breaches],
    }


def certificate_data(certificate: BoundCertificate) -> dict[str, Any]:
    """``apart``: requirements of which no two fit one layer. ``weighted``: weights as ``[above, below]`` the line."""
    return {
        "bound": certificate.bound,
        "apart": [requirement_data(requirement) for requirement in certificate.conflicting],
        "weighted": [
            [{**requirement_data(r), "weight": [w.numerator, w.denominator]} for r, w in part.items()]
            for part in certificate.weighted_parts
        ],
    }


def requirement_data(requirement: Requirement) -> dict[str, Any]:
    """``{"collide": [a, b]}`` or ``{"laser": l, "sees": e}``."""
    if isinstance(requirement, SightRequirement):
        return {"laser": requirement.laser, "sees": requirement.entity}
    return {"collide": [requirement.a, requirement.b]}


def sacrifice_data(sacrifice: Relaxation) -> dict[str, Any]:
    """The requirements dropped or allowed, a lower bound on their number (0: not proved), and the layers then needed."""
    return {
        "what": [requirement_data(requirement) for requirement in sacrifice.requirements],
        "at_least": sacrifice.lower_bound,
        "size": sacrifice.plan.size,
    }


def breach_data(breach: RequirementBreach) -> dict[str, Any]:
    return {
        **requirement_data(breach.requirement),
        "wanted": breach.is_missing,
        "layers": list(breach.layers),
        "words": str(breach),
    }


def patch_data(patch: WorldPatch) -> dict[str, Any]:
    return {
        "diff": patch.diff(),
        "files": [str(file.path) for file in patch.files],
        "left_alone": [
            {"file": str(left.path), "reason": left.reason, "by_hand": list(left.by_hand)}
            for left in patch.skipped
        ],
    }


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

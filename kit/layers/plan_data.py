"""Plans and checks as plain data, for ``--json``: the same facts as the text, under names that stay."""

from __future__ import annotations

from typing import Any

from kit.layers.assignment import LayerAssignment, RequirementBreach
from kit.layers.flatland.world_patch import WorldPatch
from kit.layers.flatland.world_planning import WorldPlan
from kit.layers.greedy import GreedyRun
from kit.layers.planning import BoundCertificate, LayerPlan
from kit.layers.relaxation import Relaxation
from kit.layers.requirements import LayerCase, Requirement, SightRequirement
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

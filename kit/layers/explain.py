"""Plans and proofs in words, as lines of at most 80 characters unless told otherwise, for terminals and screen
readers alike."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from fractions import Fraction
from functools import partial
from itertools import combinations

from kit.layers.bound_certificates import BoundCertificate
from kit.layers.flatland.world_patch import WorldPatch
from kit.layers.flatland.world_planning import WorldPlan
from kit.layers.greedy import CollisionStep, GreedyRun, LaserStep
from kit.layers.planning import LayerPlan
from kit.layers.relaxations import Relaxation
from kit.layers.requirements import LayerCase, Requirement, SightRequirement, layer_conflict
from kit.plain_text import counted, join_with_and, wrap
from kit.world.records import MAX_LAYERS

WIDTH = 80


def paragraph(text: str, *, width: int = WIDTH, indent: str = "", later: str | None = None) -> list[str]:
    """A paragraph; ``later`` is the indent of its further lines."""
    return wrap(text, width, indent, indent if later is None else later)


def members_text(case: LayerCase, members: Collection[str]) -> str:
    """{a, b, c}, in the case's order."""
    return f"{{{', '.join(name for name in case.names if name in members)}}}"


def requirement_text(requirement: Requirement, case: LayerCase) -> str:
    """A requirement as a statement: "a and b collide"."""
    if isinstance(requirement, SightRequirement):
        return f"{requirement.laser} sees {requirement.entity}"
    if requirement.a != requirement.b:
        return f"{requirement.a} and {requirement.b} collide"
    if case.by_name[requirement.a].kind == "map":
        return f"{requirement.a} has at least one name"
    return f"the copies of {requirement.a} collide with each other"


def case_text(case: LayerCase, *, width: int = WIDTH) -> list[str]:
    """Describes a case: counts, then the required collisions and what the lasers must see."""
    say = partial(paragraph, width=width)
    maps = [entity.name for entity in case.entities if entity.kind == "map"]
    others = [entity.name for entity in case.entities if entity.kind != "map"]
    lines = say(f"Maps: {', '.join(maps) or 'none'}. Bodies: {', '.join(others) or 'none'}.")
    for contact in case.collide:
        lines += say(requirement_text(contact, case), indent="  ", later="    ")
    for laser in case.lasers:
        seen = [name for name in case.names if name in laser.sees]
        lines += say(f"{laser.name} sees {join_with_and(seen) or 'nothing'}", indent="  ", later="    ")
    return lines


# The slides' method


def greedy_text(run: GreedyRun, *, draw: Callable[[int], Iterable[str]] | None = None) -> Iterator[str]:
    """The method as it is taught, clique by clique, then laser by laser.

    ``draw``: the picture that goes with a collision step, by its number from 0.
    """
    edges = run.case.edges()
    yield f"Edges: {len(edges)}"
    yield from paragraph(", ".join(map(str, edges)) or "none", indent="  ")
    for number, step in enumerate(run.collision_steps, start=1):
        yield ""
        yield from collision_step_text(run.case, number, step)
        if draw is not None:
            yield from draw(number - 1)
    for laser_step in run.laser_steps:
        yield ""
        yield from laser_step_text(run.case, laser_step)
    yield ""
    yield from greedy_end_text(run)


def greedy_end_text(run: GreedyRun, *, width: int = WIDTH) -> list[str]:
    """Describes the result of the method, and what it left open."""
    say = partial(paragraph, width=width)
    lines = say(f"The slides' method ends with {counted(run.size, 'layer')}.")
    if run.missed:
        lines += say(
            f"It leaves a hole: {join_with_and(run.missed)} (laser > what it should see). What collides with nothing is in "
            "no collision layer, so the method never shows it to a laser. Give it a layer of its own."
        )
    return lines


def collision_step_text(
    case: LayerCase, number: int, step: CollisionStep, *, width: int = WIDTH
) -> list[str]:
    """One collision layer: the edge, what joined, what is struck, what is left."""
    say = partial(paragraph, width=width)
    left = len(step.choices)
    lines = say(
        f"Step {number}. {f'Of {left} edges left, take' if left > 1 else 'Take the last edge,'} {step.edge}."
    )
    for growth in step.growth:
        also = [name for name in growth.choices if name != growth.added]
        choice = f" ({join_with_and(also)} could have joined instead)" if also else ""
        lines += say(f"{growth.added} collides with each of these: it joins{choice}.", indent="  ")
    lines += say(
        f"Nothing {'more ' if step.growth else ''}collides with each of them. "
        f"Layer {step.layer.name} = {members_text(case, step.layer.members)}.",
        indent="  ",
    )
    struck, still = join_with_and(step.covered_edges), left - len(step.covered_edges)
    lines += say(f"This covers {struck}; {counted(still, 'edge') if still else 'no edge'} left.", indent="  ")
    return lines


def laser_step_text(case: LayerCase, step: LaserStep, *, width: int = WIDTH) -> list[str]:
    """One laser: its groups, what becomes of each, and the layers it watches."""
    say = partial(paragraph, width=width)
    lines = say(f"Laser {step.laser}. In each collision layer, group what it must see.")
    endings = {
        "whole layer": "the whole layer, so {} itself serves",
        "known group": "a group that exists already, {}",
        "new layer": "a new layer, {}",
        "inside another": "inside {}: not needed",
    }
    for group in step.groups:
        members = members_text(case, group.members)
        lines += say(f"{group.source}: {members}, {endings[group.outcome].format(group.layer)}.", indent="  ")
    lines += say(f"{step.laser} watches {join_with_and(step.watches) or 'nothing'}.", indent="  ")
    return lines


# The optimum and its proof


def layer_count_text(plan: LayerPlan, *, width: int = WIDTH) -> list[str]:
    """Describes the number of layers, and whether it is proved minimal."""
    say = partial(paragraph, width=width)
    if plan.is_optimal:
        return say(f"{counted(plan.size, 'layer')}, and no plan has fewer.")
    return say(
        f"{counted(plan.size, 'layer')} found. Proved so far: at least {plan.bound} are needed, so the best plan may "
        f"have up to {plan.gap} fewer. The time was up; --time-limit gives it more."
    )


def proof_text(plan: LayerPlan, *, every_pair: bool = False, width: int = WIDTH) -> list[str]:
    """Explains why no plan has fewer layers than the bound. ``every_pair``: with the reason for each two requirements."""
    say = partial(paragraph, width=width)
    certificate = plan.certificate
    lines = (
        _packing_text(plan.case, certificate, every_pair=every_pair, width=width)
        if certificate.conflicting
        else []
    )
    for part in certificate.weighted_parts:
        lines += _weights_text(plan.case, dict(part), width)
    if not plan.size:
        return [*lines, *say("Nothing has to meet and nothing has to be seen: no layer is needed.")]
    if certificate.bound < plan.bound:
        lines += say(
            f"That proves {certificate.bound}. The solver went through every cover by the {plan.candidate_count} possible "
            f"layers and found none with fewer than {plan.bound}; there is no shorter reason to give."
        )
    elif certificate.weighted_parts and certificate.conflicting:
        lines += say(
            f"No layer counts twice in this: together that is {counted(certificate.bound, 'layer')}."
        )
    return lines


def _packing_text(
    case: LayerCase, certificate: BoundCertificate, *, every_pair: bool, width: int
) -> list[str]:
    say = partial(paragraph, width=width)
    apart = certificate.conflicting
    count = len(apart)
    if count == 1:
        lines = say("This needs a layer:")
    else:
        lines = say(f"No two of these {count} fit one layer, so they need {counted(count, 'layer')}:")
    for number, requirement in enumerate(apart, start=1):
        lines += say(requirement_text(requirement, case), indent=f"{number:>3}  ", later="     ")
    pairs = list(combinations(range(count), 2))
    shown = pairs if every_pair else [(i, i + 1) for i in range(min(3, count - 1))]
    if shown:
        lines.append("Because:" if every_pair or len(pairs) <= len(shown) else "Because, for example:")
    for i, j in shown:
        lines += say(
            f"{layer_conflict(case, apart[i], apart[j])}", indent=f"{i + 1:>3} and {j + 1}: ", later="     "
        )
    return lines


def _weights_text(case: LayerCase, weights: dict[Requirement, Fraction], width: int) -> list[str]:
    say = partial(paragraph, width=width)
    total = sum(weights.values(), Fraction(0))
    lines = say(
        f"Give these {counted(len(weights), 'requirement')} weights. No layer there can be collects more than 1, and together "
        f"they weigh {_mixed_number(total)}: they need {counted(-(-total.numerator // total.denominator), 'layer')}."
    )
    for requirement, weight in weights.items():
        lines += say(
            requirement_text(requirement, case), indent=f"{_mixed_number(weight):>5}  ", later="       "
        )
    return lines


def _mixed_number(number: Fraction) -> str:
    """7 1/2"""
    whole, rest = divmod(number.numerator, number.denominator)
    if not rest:
        return str(whole)
    return f"{whole} {rest}/{number.denominator}" if whole else f"{rest}/{number.denominator}"


def comparison_text(run: GreedyRun, plan: LayerPlan, *, width: int = WIDTH) -> list[str]:
    """The slides' method beside the plan."""
    say = partial(paragraph, width=width)
    more = run.size - plan.size
    if run.missed:
        count = len(run.missed)
        verdict = f"it also leaves {counted(count, 'thing')} unseen"
    elif more == 0:
        verdict = "as few as can be" if plan.is_optimal else "as few as the plan"
    elif more < 0:
        verdict = f"{-more} fewer than this plan, which ran out of time"
    else:
        verdict = f"{more} more than needed" if plan.is_optimal else f"{more} more than the plan"
    return say(f"The slides' method, taking edges in order: {counted(run.size, 'layer')}; {verdict}.")


# A world


def world_plan_text(plan: WorldPlan) -> list[str]:
    """Describes how many names the world has and needs, and what is wrong at present."""
    count, size = plan.current_name_count, plan.size
    file = plan.world_case.layer_lists.world.file
    lines: list[str] = []
    if plan.current_breaches:
        lines += paragraph(f"Today {file} does not do what is asked:")
        for breach in plan.current_breaches[:MAX_LISTED_BREACHES]:
            lines += paragraph(str(breach), indent="  - ", later="    ")
        if len(plan.current_breaches) > MAX_LISTED_BREACHES:
            lines.append(f"  ... and {len(plan.current_breaches) - MAX_LISTED_BREACHES} more")
    if not count:
        return [
            *lines,
            *paragraph(f"{file} names no layer: whatever is in all of them meets. Nothing can be saved."),
        ]
    proof = "and no plan has fewer" if plan.is_optimal else f"and at least {plan.bound} are needed"
    if plan.is_unchanged:
        verdict = "as few as can be" if plan.is_optimal else f"and at least {plan.bound} are needed"
        lines += paragraph(f"{file} names {counted(count, 'layer')}, {verdict}. Nothing needs to change.")
    elif plan.current_breaches:
        lines += paragraph(f"It names {counted(count, 'layer')}; what is asked takes {size}, {proof}.")
    else:
        lines += paragraph(f"{file} names {counted(count, 'layer')}. {size} would do the same, {proof}.")
    if plan.world_case.layer_lists.kept_layers:
        lines += paragraph(
            f"The layer {join_with_and(plan.world_case.layer_lists.kept_layers)} stays as it is: lasers know it by its name, and report what is "
            "in it as bright."
        )
    return lines


def world_verdict_text(plan: WorldPlan) -> list[str]:
    """The verdict on a world, in a few lines."""
    lines = world_plan_text(plan)
    if not plan.is_unchanged:
        lines += paragraph("`kit layers plan` shows which, and with --patch what to change in the files.")
    return lines


def patch_text(patch: WorldPatch) -> list[str]:
    """The diff, and what has to be done by hand."""
    lines = patch.diff().splitlines()
    for left in patch.skipped:
        lines += ["", *paragraph(f"{left.path} is left alone: {left.reason}. By hand:")]
        lines += [f"  {words}" for words in left.by_hand]
    if patch.skipped:
        lines += [
            "",
            *paragraph("These changes belong together: --apply writes none of them as long as one is left."),
        ]
    return lines or ["There is nothing to change."]


MAX_LISTED_BREACHES = 20


# What to give up


def too_many_text(plan: LayerPlan, given_up: Relaxation | None, tolerated: Relaxation | None) -> list[str]:
    """More than Flatland's sixteen layers: the two ways out, the shorter first."""
    lines = paragraph(f"Flatland has {MAX_LAYERS} layers and this plan needs {plan.size}. Ways out:")
    ways = [
        (sacrifice, words)
        for sacrifice, words in (
            (given_up, "Give up, so that it need no longer happen"),
            (tolerated, "Or allow, so that it may happen"),
        )
        if sacrifice is not None
    ]
    for sacrifice, words in sorted(ways, key=lambda way: len(way[0].requirements)):
        proof = "the fewest there are" if sacrifice.is_fewest else "perhaps not the fewest"
        words = words.removeprefix("Or ").capitalize()
        lines += paragraph(
            f"{words} ({len(sacrifice.requirements)}, {proof}; {counted(sacrifice.plan.size, 'layer')} then do):"
        )
        for requirement in sacrifice.requirements:
            lines += paragraph(requirement_text(requirement, plan.case), indent="    - ", later="      ")
    if not ways:
        lines += paragraph(
            "None was found in the time given. Split the world, or give models the same needs.", indent="  "
        )
    return lines

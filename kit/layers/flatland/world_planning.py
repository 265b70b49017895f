"""The plan of a Flatland world: as few layer names as can be, called what the world calls them already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from kit.layers.assignment import LayerAssignment, NamedLayer, RequirementBreach, find_breaches
from kit.layers.flatland.world_case import WorldCase
from kit.layers.planning import DEFAULT_TIME_LIMIT, LayerPlan, solve_layers
from kit.layers.requirements import ContactRequirement
from kit.world.problems import Problem, WorldError
from kit.world.records import SourceLocation

NO_MAP: Final = ""
"""Stands for the map of layers without one."""


@dataclass(frozen=True, slots=True)
class WorldPlan:
    """The planned layer lists of a world, compared with the present ones."""

    world_case: WorldCase
    plan: LayerPlan
    """The plan for the requirements that the kept layers do not meet."""
    assignment: LayerAssignment
    """The assignment with the world's names; the current one if the plan is not better."""

    @property
    def current_breaches(self) -> tuple[RequirementBreach, ...]:
        """Where the current world does not meet the requirements."""
        return self.world_case.current_breaches

    @property
    def current_name_count(self) -> int:
        """Layer names in the world file, whether anything uses them or not: all count towards the sixteen."""
        return len(self.world_case.layer_lists.world.layer_bits)

    @property
    def size(self) -> int:
        return len(self.assignment.layers)

    @property
    def bound(self) -> int:
        """Proved: no plan needs fewer names (as long as the kept layers stay)."""
        return self.plan.bound + len(self.world_case.layer_lists.kept_layers)

    @property
    def is_optimal(self) -> bool:
        return self.bound == self.size

    @property
    def is_unchanged(self) -> bool:
        return self.assignment == self.world_case.current_assignment


def plan_world(world_case: WorldCase, *, time_limit: float = DEFAULT_TIME_LIMIT) -> WorldPlan:
    """The fewest layers for a world. Where today's lists do what is asked with as few, they stay as they are.

    Raises WorldError where a layer that has to be kept brings about what must not happen.
    """
    case, current = world_case.case, world_case.current_assignment
    kept = [layer for layer in current.layers if layer.name in world_case.layer_lists.kept_layers]
    kept_watches = {
        laser: tuple(name for name in watched if name in world_case.layer_lists.kept_layers)
        for laser, watched in current.watches.items()
    }
    served = [
        requirement
        for requirement in case.requirements
        if (
            any(requirement.a in layer.members and requirement.b in layer.members for layer in kept)
            if isinstance(requirement, ContactRequirement)
            else any(
                requirement.entity in layer.members and layer.name in kept_watches[requirement.laser]
                for layer in kept
            )
        )
    ]
    plan = solve_layers(case.without_requirements(served), time_limit=time_limit)
    if not world_case.current_breaches and plan.size + len(kept) >= len(current.layers):
        return WorldPlan(world_case, plan, current)
    named = with_existing_names(world_case, plan.assignment)
    assignment = LayerAssignment(
        (*named.layers, *kept),
        {laser: (*watched, *kept_watches[laser]) for laser, watched in named.watches.items()},
    )
    assignment = restore_memberships(world_case, assignment)
    if found := find_breaches(case, assignment):  # only what is kept can be the reason
        raise WorldError(
            [
                Problem(
                    SourceLocation(world_case.layer_lists.world.file),
                    f"{found[0]}: this layer is kept as it is",
                )
            ]
        )
    return WorldPlan(world_case, plan, assignment)


def restore_memberships(world_case: WorldCase, assignment: LayerAssignment) -> LayerAssignment:
    """The assignment with everything back in the layers where it is today, as far as that does no harm.

    So the files change no more than they have to: what is in all layers, and may be, stays there.
    """
    case, current = (
        world_case.case,
        {layer.name: layer.members for layer in world_case.current_assignment.layers},
    )
    layers: list[NamedLayer] = []
    for layer in assignment.layers:
        members = set(layer.members)
        watchers = [
            case.laser[laser] for laser, watched in assignment.watches.items() if layer.name in watched
        ]
        for name in case.names:
            if (
                name in current.get(layer.name, ())
                and all(case.relation(name, member) != "apart" for member in (*members, name))
                and all(laser.sighting(name) != "blind" for laser in watchers)
            ):
                members.add(name)
        layers.append(NamedLayer(layer.name, frozenset(members)))
    watches = {
        laser: tuple(
            layer.name
            for layer in layers
            if layer.name in watched
            or (
                layer.name in world_case.current_assignment.watches[laser]
                and all(case.laser[laser].sighting(member) != "blind" for member in layer.members)
            )
        )
        for laser, watched in assignment.watches.items()
    }
    return LayerAssignment(tuple(layers), watches)


def with_existing_names(world_case: WorldCase, assignment: LayerAssignment) -> LayerAssignment:
    """The assignment with names the world has, each where it is most at home.

    A layer with a map takes a name of that map's entry, one without a map a name of an entry without. The first
    name of an entry is what the world calls its walls, and a name that a plugin speaks of must go on to exist: they
    are given away first. Then each name goes to the layer that resembles it most.
    """
    old_names = _names_by_map(world_case)
    homes = [_map_name(world_case, layer) for layer in assignment.layers]
    chosen: dict[int, str] = {}
    for home in dict.fromkeys(homes):
        layers = [i for i, h in enumerate(homes) if h == home]
        chosen.update(_match_names(world_case, assignment, layers, old_names.get(home, ())))
    taken = {*world_case.layer_lists.world.layer_bits, *chosen.values()}
    for i, home in enumerate(homes):
        if i not in chosen:
            number = 2 if home else 1
            while (name := f"{home or 'free'}_{number}") in taken:
                number += 1
            chosen[i] = name
            taken.add(name)
    in_order = {name: i for i, name in enumerate(world_case.layer_lists.world.layer_bits)}
    ranks = sorted(range(len(homes)), key=lambda i: (in_order.get(chosen[i], len(in_order)), i))
    new = {layer.name: chosen[i] for i, layer in enumerate(assignment.layers)}
    return LayerAssignment(
        tuple(NamedLayer(chosen[i], assignment.layers[i].members) for i in ranks),
        {
            laser: tuple(chosen[i] for i in ranks if chosen[i] in {new[name] for name in watched})
            for laser, watched in assignment.watches.items()
        },
    )


def _map_name(world_case: WorldCase, layer: NamedLayer) -> str:
    maps = [e.name for e in world_case.case.entities if e.kind == "map" and e.name in layer.members]
    return maps[0] if maps else NO_MAP


def _names_by_map(world_case: WorldCase) -> dict[str, tuple[str, ...]]:
    names: dict[str, tuple[str, ...]] = {}
    for layer in world_case.layer_lists.world.layers:
        home = layer.name if layer.walls is not None else NO_MAP
        names[home] = (
            *names.get(home, ()),
            *(name for name in layer.names if name not in world_case.layer_lists.kept_layers),
        )
    return names


def _match_names(
    world_case: WorldCase, assignment: LayerAssignment, layers: Sequence[int], names: Sequence[str]
) -> dict[int, str]:
    """A name for as many of the layers as there are names, by resemblance."""
    import networkx

    wanted = names_used_by_plugins(world_case)
    graph: networkx.Graph[tuple[str, object]] = networkx.Graph()
    for i in layers:
        for rank, name in enumerate(names):
            weight = (10_000 if rank == 0 or name in wanted else 100) + 99 * _similarity(
                world_case, assignment, i, name
            )
            graph.add_edge(("layer", i), ("name", name), weight=weight)
    matching = networkx.max_weight_matching(graph, maxcardinality=True)
    pairs = [pair if pair[0][0] == "layer" else (pair[1], pair[0]) for pair in matching]
    return {int(layer[1]): str(name[1]) for layer, name in pairs}


def names_used_by_plugins(world_case: WorldCase) -> frozenset[str]:
    """Layer names that a plugin of the world refers to (a RandomWall names the layer it builds in)."""
    found = set()
    for plugin in world_case.layer_lists.world.plugins:
        if isinstance(plugin.params, Mapping):
            found.add(str(plugin.params.get("layer", "")))
    return frozenset(found)


def _similarity(world_case: WorldCase, assignment: LayerAssignment, i: int, name: str) -> float:
    """Returns the Jaccard similarity of a present and a planned layer: members and lasers in both over those in either."""

    def contents(by: LayerAssignment, layer: NamedLayer) -> set[tuple[str, str]]:
        members = {("member", member) for member in layer.members}
        return members | {("laser", laser) for laser, watched in by.watches.items() if layer.name in watched}

    current = next(layer for layer in world_case.current_assignment.layers if layer.name == name)
    old, new = contents(world_case.current_assignment, current), contents(assignment, assignment.layers[i])
    return len(old & new) / max(1, len(old | new))

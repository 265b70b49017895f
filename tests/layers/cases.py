"""Cases made by rule and by chance, and an optimum found in a way of its own: for the tests and the benchmark."""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

from kit.layers.assignment import LayerAssignment, NamedLayer
from kit.layers.requirements import ContactRequirement, LaserEntity, LayerCase, LayerEntity

SLIDES_ANSWER = {
    "C1": ("Map1 M4.B1 M4.B2", ""),
    "C2": ("M4.B1 M4.B2 M2", ""),
    "C3": ("M2 M3.B2", ""),
    "C4": ("M3.B2 M1", "Ls3"),
    "C5": ("Map2 M1 M3.B1", ""),
    "C6": ("Map2 M2 M3.B1", ""),
    "L1": ("Map1 M4.B1", "Ls1 Ls3"),
    "L2": ("M2 Map2", "Ls2"),
    "L3": ("Map2 M1", "Ls2"),
    "L4": ("Map2", "Ls1"),
}
"""The slides' own answer to ``slides-lasers``: the members of each layer, and the lasers that watch it."""


def slides_assignment() -> LayerAssignment:
    return LayerAssignment(
        tuple(NamedLayer(name, frozenset(members.split())) for name, (members, _) in SLIDES_ANSWER.items()),
        {
            laser: tuple(name for name, (_, lasers) in SLIDES_ANSWER.items() if laser in lasers.split())
            for laser in ("Ls1", "Ls2", "Ls3")
        },
    )


def graph(
    edges: str, *, lasers: Mapping[str, str] | None = None, either: str = "", maps: str = ""
) -> LayerCase:
    """A case from text: edges as ``a-b``, names separated by spaces."""

    def pairs(text: str) -> list[tuple[str, str]]:
        return [(a, b) for a, b in (edge.split("-") for edge in text.split())]

    seen = " ".join((lasers or {}).values()).split()
    names = dict.fromkeys([*(name for pair in (*pairs(edges), *pairs(either)) for name in pair), *seen])
    return LayerCase(
        tuple(LayerEntity(name, "map" if name in maps.split() else "bodies") for name in names),
        tuple(ContactRequirement(a, b) for a, b in pairs(edges)),
        frozenset(ContactRequirement(a, b) for a, b in pairs(either)),
        tuple(LaserEntity(name, frozenset(sees.split())) for name, sees in (lasers or {}).items()),
    )


def complete(count: int) -> LayerCase:
    return graph(" ".join(f"v{i}-v{j}" for i, j in combinations(range(count), 2)))


def bipartite(left: int, right: int) -> LayerCase:
    return graph(" ".join(f"a{i}-b{j}" for i in range(left) for j in range(right)))


def cocktail_party(couples: int) -> LayerCase:
    """Everybody meets everybody but their own partner."""
    people = [f"{side}{i}" for i in range(couples) for side in "lr"]
    return graph(" ".join(f"{a}-{b}" for a, b in combinations(people, 2) if a[1:] != b[1:]))


def random_tree(rng: random.Random, count: int) -> LayerCase:
    return graph(" ".join(f"v{rng.randrange(i)}-v{i}" for i in range(1, count)))


def random_graph(rng: random.Random, count: int, density: float) -> LayerCase:
    names = [f"v{i}" for i in range(count)]
    edges = [pair for pair in combinations(names, 2) if rng.random() < density]
    return LayerCase(tuple(map(LayerEntity, names)), tuple(ContactRequirement(a, b) for a, b in edges))


def random_case(
    rng: random.Random, entities: int, lasers: int, density: float, *, either: float = 0.1, odd: bool = True
) -> LayerCase:
    """Contacts at ``density``; of the rest some left open; lasers that see more or less.

    ``odd``: some entities are maps, ghosts, or stand for several copies.
    """
    things = [LayerEntity(f"e{i}", *_oddity(rng) if odd else ("bodies",)) for i in range(entities)]
    collide: list[ContactRequirement] = []
    open_: set[ContactRequirement] = set()
    for a, b in combinations(things, 2):
        dice = rng.random()
        if a.kind == b.kind == "map":
            continue
        if dice < density and not a.is_ghost and not b.is_ghost:
            collide.append(ContactRequirement(a.name, b.name))
        elif dice < density + either:
            open_.add(ContactRequirement(a.name, b.name))
    for thing in things:
        if thing.copies > 1 and not thing.is_ghost:
            (collide.append if rng.random() < 0.5 else open_.add)(ContactRequirement(thing.name, thing.name))
    eyes = []
    for i in range(lasers):
        sharp = rng.random()
        drawn = {thing.name: rng.random() for thing in things}
        eyes.append(
            LaserEntity(
                f"l{i}",
                frozenset(name for name, d in drawn.items() if d < sharp),
                frozenset(name for name, d in drawn.items() if sharp <= d < sharp + either),
            )
        )
    return LayerCase(tuple(things), tuple(collide), frozenset(open_), tuple(eyes))


def _oddity(rng: random.Random) -> tuple[str, str, int, bool]:
    dice = rng.random()
    return ("map" if dice < 0.15 else "bodies", "", 2 if 0.15 < dice < 0.25 else 1, dice > 0.95)


def planted(rng: random.Random, entities: int, lasers: int, layers: int, largest: int) -> LayerCase:
    """What a world of so many layers does: a case of which one knows that ``layers`` are enough."""
    names = [f"e{i}" for i in range(entities)]
    groups = [rng.sample(names, rng.randint(2, largest)) for _ in range(layers)]
    pairs = {ContactRequirement(a, b) for group in groups for a, b in combinations(group, 2)}
    eyes = []
    for i in range(lasers):
        watched = rng.sample(groups, min(layers, rng.randint(1, 3)))
        eyes.append(LaserEntity(f"l{i}", frozenset(name for group in watched for name in group)))
    return LayerCase(tuple(map(LayerEntity, names)), tuple(sorted(pairs)), lasers=tuple(eyes))


Layer = tuple[int, int]
"""Members and lasers that watch, as bits."""


def fewest_layers(case: LayerCase) -> int:
    """The optimum by exhaustive search, which shares nothing with the planner but the meaning of a case.

    Every requirement is put into a layer: one that has it already, one that can take it, or a new one; the
    requirement with the fewest choices first, for 0, 1, 2, ... layers.
    """
    bit = {name: 1 << i for i, name in enumerate(case.names)}
    laser_bit = {laser.name: 1 << i for i, laser in enumerate(case.lasers)}
    apart = {bit[a]: sum(bit[b] for b in case.names if case.relation(a, b) == "apart") for a in case.names}
    blind = {laser_bit[laser.name]: _bits(bit, case.blind_set(laser)) for laser in case.lasers}
    contacts = [(bit[c.a] | bit[c.b], 0) for c in case.collide]
    sights = [(bit[name], laser_bit[laser.name]) for laser in case.lasers for name in laser.sees]

    def joined(layer: Layer, need: Layer) -> Layer | None:
        members, watchers = layer[0] | need[0], layer[1] | need[1]
        if any(members & one and members & others for one, others in apart.items()):
            return None
        if any(watchers & one and members & unseen for one, unseen in blind.items()):
            return None
        return members, watchers

    def possible(layers: Sequence[Layer], needs: Sequence[Layer], count: int) -> bool:
        fewest: tuple[int, Layer, list[tuple[int, Layer]]] | None = None
        for need in needs:
            if any(need[0] & ~members == 0 and need[1] & ~watchers == 0 for members, watchers in layers):
                continue
            choices = [(i, grown) for i, layer in enumerate(layers) if (grown := joined(layer, need))]
            choice = (len(choices) + (len(layers) < count), need, choices)
            if choice[0] == 0:
                return False
            if fewest is None or choice[0] < fewest[0]:
                fewest = choice
        if fewest is None:
            return True
        _, need, choices = fewest
        rest = [other for other in needs if other is not need]
        for i, grown in choices:
            if possible([*layers[:i], grown, *layers[i + 1 :]], rest, count):
                return True
        return len(layers) < count and possible([*layers, need], rest, count)

    return next(
        count for count in range(len(contacts) + len(sights) + 1) if possible([], contacts + sights, count)
    )


def _bits(bit: Mapping[str, int], names: Iterable[str]) -> int:
    return sum(bit[name] for name in names)

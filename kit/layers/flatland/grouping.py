"""The relations of all layer lists of a world, and which lists can be one entity.

Layer lists of the same model instances are merged where one requires nothing that another does not require as well: giving
the first the list of the second breaks nothing and costs nothing, so the optimum stays what it is, and the groups
are those a person would draw: a robot, or the parts of it that differ.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from itertools import combinations, product
from typing import Final, TypeVar

from kit.layers.flatland.layer_lists import FootprintUse, LaserLayerList, LayerList, LayerLists
from kit.layers.requirements import Relation, Sighting
from kit.world.problems import Problem, WorldError
from kit.world.records import LaserMount as View

T = TypeVar("T", Relation, Sighting)
L = TypeVar("L", str, FootprintUse)

PairRelation = Callable[[FootprintUse, FootprintUse], Relation]
"""Returns the required relation of two uses that can collide."""

LaserRelation = Callable[[LaserLayerList, tuple[str, View], FootprintUse], Sighting]
"""Returns the required relation of a laser of one model and a use that it can see."""


class RelationTable:
    """The relations of all layer lists, before any are merged. ``rows``: the maps, then the bodies."""

    def __init__(self, slots: LayerLists, pair: PairRelation, view: LaserRelation) -> None:
        self._layer_lists, self._relation_of_pair, self._relation_of_laser = slots, pair, view
        self.rows: tuple[LayerList, ...] = (*slots.maps, *slots.bodies)
        count = len(self.rows)
        self.relation: list[list[Relation]] = [["either"] * count for _ in range(count)]
        for i in range(count):
            for j in range(i + 1):
                self.relation[i][j] = self.relation[j][i] = self._pair_relation(i, j)
        self.sighting: list[list[Sighting]] = [
            [self._laser_relation(laser, slot) for slot in self.rows] for laser in slots.lasers
        ]

    def _pair_relation(self, i: int, j: int) -> Relation:
        a, b = self.rows[i], self.rows[j]
        if not a.models and not b.models:  # maps: each needs a name, and a name belongs to one of them
            return "collide" if i == j else "apart"
        pairs = combinations(a.uses, 2) if i == j else product(a.uses, b.uses)
        wishes = (
            (self._relation_of_pair(p, q), p, q) for p, q in pairs if self._layer_lists.can_collide(p, q)
        )
        return _combine(
            "either",
            wishes,
            lambda p, q, wish: f"{p.address} {_MODAL_VERBS[wish]} collide with {q.address}",
            a,
        )

    def _laser_relation(self, laser: LaserLayerList, slot: LayerList) -> Sighting:
        wishes = (
            (self._relation_of_laser(laser, use, spot), use[0], spot)
            for use, spot in product(laser.uses, slot.uses)
            if self._layer_lists.can_see(use, spot)
        )
        return _combine(
            "either",
            wishes,
            lambda model, spot, wish: f"{model}/{laser.plugin} {_MODAL_VERBS[wish]} see {spot.address}",
            slot,
        )

    def merge_lists(self) -> list[list[int]]:
        """Returns the lists in groups of equal needs, the neediest of each group first."""
        groups = {i: [i] for i in range(len(self.rows))}
        families: defaultdict[tuple[object, int], list[int]] = defaultdict(list)
        for i, slot in enumerate(self.rows):
            if models := slot.models:
                families[models, self._layer_lists.kept_bits(slot)].append(i)
        for family in families.values():
            while pair := self._mergeable(family, groups):
                strong, weak = pair
                self._merge_needs(strong, weak)
                groups[strong] += groups.pop(weak)
                family.remove(weak)
        return [sorted(group, key=lambda i: (i != head, i)) for head, group in groups.items()]

    def _mergeable(self, family: list[int], groups: Mapping[int, list[int]]) -> tuple[int, int] | None:
        """Two of the family of which the first can absorb the second."""
        pairs = ((strong, weak) for weak in reversed(family) for strong in family if strong != weak)
        return next((pair for pair in pairs if self._can_absorb(*pair, groups)), None)

    def _merge_needs(self, strong: int, weak: int) -> None:
        """Makes the needs of ``strong`` those of both."""
        for relation in ("apart", "collide"):
            if relation in (self.relation[strong][weak], self.relation[weak][weak]):
                self.relation[strong][strong] = relation
        for w, relation in enumerate(self.relation[weak]):
            if relation == "apart" and w != strong:
                self.relation[strong][w] = self.relation[w][strong] = "apart"
        for seen in self.sighting:
            if seen[weak] == "blind":
                seen[strong] = "blind"

    def _can_absorb(self, strong: int, weak: int, groups: Mapping[int, list[int]]) -> bool:
        """Returns whether ``weak`` asks nothing that ``strong`` does not ask as well, and the two may be together."""
        if self._has_no_needs(strong) and self._has_no_needs(weak):
            return True  # both have an empty list, and keep it
        own, shared = self.relation[weak][weak], self.relation[strong][weak]
        if shared == "apart" or (
            own not in ("either", self.relation[strong][strong]) and shared != "collide"
        ):
            return False
        mine, its = self.relation[weak], self.relation[strong]
        return all(mine[w] in ("either", its[w]) for w in groups if w not in (strong, weak)) and all(
            seen[weak] in ("either", seen[strong]) for seen in self.sighting
        )

    def _has_no_needs(self, i: int) -> bool:
        if any(spot.category for spot in self.rows[i].uses):
            return False
        return "collide" not in self.relation[i] and all(seen[i] != "sees" for seen in self.sighting)


_MODAL_VERBS: Final[Mapping[Relation | Sighting, str]] = {
    "collide": "must",
    "apart": "must not",
    "sees": "must",
    "blind": "must not",
    "either": "may",
}


def _combine(
    open_: T,
    wishes: Iterable[tuple[T, L, FootprintUse]],
    in_words: Callable[[L, FootprintUse, T], str],
    slot: LayerList,
) -> T:
    """Combines the relations required of one list: yes or no, if any is required. Raises WorldError if both are."""
    said: dict[T, tuple[L, FootprintUse]] = {}
    for wish, who, spot in wishes:
        if wish != open_:
            said.setdefault(wish, (who, spot))
    if len(said) > 1:
        words = ", and ".join(in_words(*who, wish) for wish, who in said.items())
        problem = (
            f"contradiction: {words}, but one list of layers serves both: give one of them a file of its own"
        )
        raise WorldError([Problem(slot.location, problem)])
    return next(iter(said), open_)

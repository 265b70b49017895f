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

    def __init__(self, layer_lists: LayerLists, pair: PairRelation, view: LaserRelation) -> None:
        self._layer_lists, self._relation_of_pair, self._relation_of_laser = layer_lists, pair, view
        self.rows: tuple[LayerList, ...] = (*layer_lists.maps, *layer_lists.bodies)
        count = len(self.rows)
        self.relation: list[list[Relation]] = [["either"] * count for _ in range(count)]
        for i in range(count):
            for j in range(i + 1):
                self.relation[i][j] = self.relation[j][i] = self._pair_relation(i, j)
        self.sighting: list[list[Sighting]] = [
            [self._laser_relation(laser, layer_list) for layer_list in self.rows]
            for laser in layer_lists.lasers
        ]

    def _pair_relation(self, i: int, j: int) -> Relation:
        a, b = self.rows[i], self.rows[j]
        if not a.models and not b.models:  # maps: each needs a name, and a name belongs to one of them
            return "collide" if i == j else "apart"
        pairs = combinations(a.uses, 2) if i == j else product(a.uses, b.uses)
        relations = (
            (self._relation_of_pair(p, q), p, q) for p, q in pairs if self._layer_lists.can_collide(p, q)
        )
        return _combine(
            "either",
            relations,
            lambda p, q, relation: f"{p.address} {_MODAL_VERBS[relation]} collide with {q.address}",
            a,
        )

    def _laser_relation(self, laser: LaserLayerList, layer_list: LayerList) -> Sighting:
        relations = (
            (self._relation_of_laser(laser, laser_use, use), laser_use[0], use)
            for laser_use, use in product(laser.uses, layer_list.uses)
            if self._layer_lists.can_see(laser_use, use)
        )
        return _combine(
            "either",
            relations,
            lambda model, use, relation: f"{model}/{laser.plugin} {_MODAL_VERBS[relation]} see {use.address}",
            layer_list,
        )

    def merge_lists(self) -> list[list[int]]:
        """Returns the lists in groups of equal needs, the neediest of each group first."""
        groups = {i: [i] for i in range(len(self.rows))}
        families: defaultdict[tuple[object, int], list[int]] = defaultdict(list)
        for i, layer_list in enumerate(self.rows):
            if models := layer_list.models:
                families[models, self._layer_lists.kept_bits(layer_list)].append(i)
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
        if any(use.category for use in self.rows[i].uses):
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
    relations: Iterable[tuple[T, L, FootprintUse]],
    in_words: Callable[[L, FootprintUse, T], str],
    layer_list: LayerList,
) -> T:
    """Combines the relations required of one list: yes or no, if any is required. Raises WorldError if both are."""
    stated: dict[T, tuple[L, FootprintUse]] = {}
    for relation, who, use in relations:
        if relation != open_:
            stated.setdefault(relation, (who, use))
    if len(stated) > 1:
        words = ", and ".join(in_words(*who, relation) for relation, who in stated.items())
        problem = (
            f"contradiction: {words}, but one list of layers serves both: give one of them a file of its own"
        )
        raise WorldError([Problem(layer_list.location, problem)])
    return next(iter(stated), open_)

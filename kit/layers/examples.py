"""Cases to learn from: three small ones, the twelve edges of the slides, and two on which the greedy method fails."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from types import MappingProxyType
from typing import Final

from kit.layers.requirements import Case, Contact, Entity, Laser


def _case(
    title: str,
    edges: str,
    *,
    maps: str = "",
    ghosts: str = "",
    others: str = "",
    lasers: Mapping[str, str] = MappingProxyType({}),
) -> Case:
    """A case from text: edges as ``a-b``, names separated by spaces, ``model.part`` for a part of a model."""
    pairs = [edge.split("-") for edge in edges.split()]
    names = dict.fromkeys([*maps.split(), *(name for pair in pairs for name in pair), *ghosts.split(), *others.split()])
    return Case(
        tuple(
            Entity(
                name,
                kind="map" if name in maps.split() else "bodies",
                model="" if name in maps.split() else name.partition(".")[0],
                ghost=name in ghosts.split(),
            )
            for name in names
        ),
        tuple(Contact(a, b) for a, b in pairs),
        lasers=tuple(Laser(name, frozenset(sees.split())) for name, sees in lasers.items()),
        title=title,
    )

"""Cases to learn from: three small ones, the twelve edges of the slides, and two on which the greedy method fails."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from kit.layers.requirements import ContactRequirement, LaserEntity, LayerCase, LayerEntity


def _case_from_text(
    title: str,
    edges: str,
    *,
    maps: str = "",
    ghosts: str = "",
    others: str = "",
    lasers: Mapping[str, str] = MappingProxyType({}),
) -> LayerCase:
    """A case from text: edges as ``a-b``, names separated by spaces, ``model.part`` for a part of a model."""
    pairs = [edge.split("-") for edge in edges.split()]
    names = dict.fromkeys(
        [*maps.split(), *(name for pair in pairs for name in pair), *ghosts.split(), *others.split()]
    )
    return LayerCase(
        tuple(
            LayerEntity(
                name,
                kind="map" if name in maps.split() else "bodies",
                model="" if name in maps.split() else name.partition(".")[0],
                is_ghost=name in ghosts.split(),
            )
            for name in names
        ),
        tuple(ContactRequirement(a, b) for a, b in pairs),
        lasers=tuple(LaserEntity(name, frozenset(sees.split())) for name, sees in lasers.items()),
        title=title,
    )


_TWELVE_EDGES = (
    "Map1-M4.B1 Map1-M4.B2 M4.B1-M4.B2 M4.B1-M2 M4.B2-M2 M2-Map2 "
    "M2-M3.B1 M2-M3.B2 Map2-M3.B1 Map2-M1 M3.B1-M1 M3.B2-M1"
)

EXAMPLES: Final[Mapping[str, LayerCase]] = MappingProxyType(
    {
        "two": _case_from_text("A robot between walls: one layer", "walls-robot", maps="walls"),
        "blind-spot": _case_from_text(
            "The robot touches the walls; its laser must see the walls and not the robot's own wheels",
            "walls-robot",
            maps="walls",
            lasers={"lidar": "walls"},
        ),
        "three": _case_from_text(
            "A robot, a person and walls: all three meet, and one layer is enough",
            "walls-robot walls-person robot-person",
            maps="walls",
        ),
        "drone": _case_from_text(
            "A robot and a drone share the walls and fly past each other: two layers",
            "walls-robot walls-drone",
            maps="walls",
        ),
        "beacon": _case_from_text(
            "A robot that sees walls, and a beacon that sees the robot and touches nothing: three layers do, not four",
            "walls-robot",
            maps="walls",
            ghosts="beacon",
            lasers={"robot.lidar": "walls", "beacon.eye": "robot"},
        ),
        "slides": _case_from_text(
            "The twelve edges of the slides: six layers, however one chooses",
            _TWELVE_EDGES,
            maps="Map1 Map2",
        ),
        "slides-lasers": _case_from_text(
            "The twelve edges of the slides with their three lasers: ten layers",
            _TWELVE_EDGES,
            maps="Map1 Map2",
            lasers={"Ls1": "Map1 M4.B1 Map2", "Ls2": "M1 M2 Map2", "Ls3": "Map1 M4.B1 M3.B2 M1"},
        ),
        "greedy-trap": _case_from_text(
            "Nine edges on which going down the list needs four layers, and three are enough",
            "a-b a-c a-d a-e b-c b-d b-f c-e c-f",
        ),
        "laser-trap": _case_from_text(
            "One laser for which the slides' method adds a layer that two others already make up for",
            "a-b a-c a-d b-c b-e",
            lasers={"eye": "a b d e"},
        ),
        "unseen": _case_from_text(
            "A lamp that touches nothing but must be seen: the slides' method never finds it",
            "walls-robot",
            maps="walls",
            others="lamp",
            lasers={"eye": "walls lamp"},
        ),
        "too-many": _case_from_text(
            "Four of one kind, five of the other, each to collide with all of the other: twenty layers, and only 16 exist",
            " ".join(f"left{i}-right{j}" for i in range(1, 5) for j in range(1, 6)),
        ),
    }
)
"""Every preset by its name, the simplest first."""

"""Who collides, who is seen, how few layers do: found out from the item's own picture."""

from __future__ import annotations

import random
from itertools import combinations
from pathlib import Path
from typing import Any

from kit.layers.assignment import find_breaches
from kit.layers.examples import EXAMPLES
from kit.layers.greedy import run_greedy
from kit.layers.planning import solve_layers
from kit.layers.requirements import ContactRequirement, LaserEntity, LayerCase, LayerEntity
from kit.school.quiz.items import QuizItem
from kit.world.collision_rules import CollisionRules, ContactKind
from tests.school.quiz.derived.finding import Derivation, Finding, nearest
from tests.sim.workshop import Workshop

EYE: dict[str, Any] = {
    "type": "Laser",
    "name": "eye",
    "body": "base",
    "range": 5,
    "angle": {"min": -3, "max": 3, "increment": 0.1},
}


def _table(item: QuizItem) -> dict[str, list[str]]:
    """Rows of the picture such as ``cart  layers  a, c``."""
    rows = [row.split("layers") for row in item.picture]
    return {name.strip(): [layer.strip() for layer in layers.split(",")] for name, layers in rows}


def _world(item: QuizItem, folder: Path) -> CollisionRules:
    """The picture as a world; ``laser`` is on a post that is in no layer, ``wall`` does not move."""
    shop, table = Workshop(folder), _table(item)
    watched = table.pop("laser", None)
    models = {
        name: shop.model(shop.circle(0.1, layers=layers), type="static" if name == "wall" else "dynamic")
        for name, layers in table.items()
    }
    if watched is not None:
        models["post"] = shop.model(shop.circle(0.1, layers=[]), plugins=[{**EYE, "layers": watched}])
    names = sorted({layer for layers in (*table.values(), watched or []) for layer in layers})
    return CollisionRules(shop.world(models, dict.fromkeys(names, ())))


def collisions_in_picture(item: QuizItem, folder: Path) -> Finding:
    pairs = frozenset(
        frozenset({a.model, b.model})
        for a, b, verdict in _world(item, folder).contact_rules()
        if verdict.kind is ContactKind.COLLIDES
    )
    names = list(_table(item))
    return Finding(
        pairs,
        {
            "All three: the drone links them": frozenset(map(frozenset, combinations(names, 2))),
            "cart with drone, and drone with barrow": frozenset(
                {frozenset({"cart", "drone"}), frozenset({"drone", "barrow"})}
            ),
            "None: no two lists are equal": frozenset(),
        },
    )


def sight_in_picture(item: QuizItem, folder: Path) -> Finding:
    seen = frozenset(
        thing.model for _, thing, seeing in _world(item, folder).visibilities() if seeing.is_visible
    )
    return Finding(
        seen,
        {
            "cart and drone": frozenset({"cart", "drone"}),
            "Only cart": frozenset({"cart"}),
            "All three": frozenset({"cart", "drone", "barrow"}),
        },
    )


def robot_and_wall(item: QuizItem, folder: Path) -> Finding:
    touching = _world(item, folder)
    found = touching.contact_rule(*touching.bodies).kind is ContactKind.COLLIDES
    return Finding(
        found,
        {
            "Yes, one shared layer is enough": True,
            "No, the two lists differ": False,
            "Only half of the robot does": "half",  # a verdict is of whole bodies
        },
    )


def laser_inside_hull(item: QuizItem, folder: Path) -> Finding:
    """By the rule, and by the rays themselves: nothing else is in the world."""
    from kit.msg.sensor_msgs import LaserScan
    from kit.sim.simulation import Simulation

    shop = Workshop(folder)
    hull = shop.rectangle(-0.2, 0.2, -0.1, 0.1, layers=["a"])
    world = shop.world({"robot": shop.model(hull, plugins=[{**EYE, "layers": ["a"]}])}, {"a": ()})
    sent = Simulation(world).step()
    (scan,) = [out.message for out in sent if isinstance(out.message, LaserScan)]
    hits = sum(value == value for value in scan.ranges)  # nan is not equal to itself
    touching = CollisionRules(world)
    assert touching.visibility(touching.lasers[0], touching.bodies[0]).is_visible == (hits > 0)
    found = "all" if hits == len(scan.ranges) else "some" if hits else "nothing"
    return Finding(
        found,
        {
            "The hull all round, at a few cm": "all",
            "Only the hull's corners": "some",
            "Nothing of the hull": "nothing",
        },
    )


def laser_own_wheels(item: QuizItem, folder: Path) -> Finding:
    shop = Workshop(folder)
    bodies = [
        {"name": "base", "footprints": [shop.circle(0.1, layers=["a"])]},
        {"name": "wheel", "pose": [0, 0.2, 0], "footprints": [shop.circle(0.05, layers=["a"])]},
    ]
    model = {"bodies": bodies, "plugins": [{**EYE, "layers": ["a"]}]}
    touching = CollisionRules(shop.world({"robot": model}, {"a": ()}))
    seen = {
        thing.body: touching.visibility(touching.lasers[0], thing).is_visible for thing in touching.bodies
    }
    assert not seen["base"]
    return Finding(
        "always" if seen["wheel"] else "never",  # the verdict knows of no movement
        {
            "Nothing, since they are its own": "never",
            "The wheels, like anything else": "always",
            "The wheels, but only as they turn": "moving",
        },
    )


def static_crate(item: QuizItem, folder: Path) -> Finding:
    shop = Workshop(folder)
    crate = shop.model(shop.circle(0.1, layers=["a"]), type="static")
    touching = CollisionRules(shop.world({"crate": crate}, {"a": [(0, -1, 0, 1)]}))
    found = touching.contact_rule(*touching.bodies).kind
    return Finding(
        found,
        {
            "Yes: they share a layer": ContactKind.COLLIDES,
            "Yes: but only by a sensor": ContactKind.SENSES,
            "No: neither of them moves": ContactKind.PASSES,
        },
    )


def one_model_two_bodies(item: QuizItem, folder: Path) -> Finding:
    """By the rule, and by a bumper in a run in which they overlap."""
    from kit.msg.flatland_msgs import Collisions
    from kit.sim.simulation import Simulation

    shop = Workshop(folder)
    bodies = [{"name": name, "footprints": [shop.circle(0.1, layers=["a"])]} for name in ("one", "other")]
    bumper = {"type": "Bumper", "name": "bumper"}
    world = shop.world({"robot": {"bodies": bodies, "plugins": [bumper]}}, {"a": ()})
    touching = CollisionRules(world)
    collide = touching.contact_rule(*touching.bodies).kind is ContactKind.COLLIDES
    sent = Simulation(world).step(5)
    reported = any(isinstance(out.message, Collisions) and out.message.collisions for out in sent)
    return Finding(
        (collide, reported),
        {
            "No: bodies of one model never collide": (False, False),
            "Yes: they are bodies like any other": (True, True),
            "Yes: but no bumper reports it": (True, False),
        },
    )


# The fewest


def _case(item: QuizItem) -> LayerCase:
    """The picture as a case: rows ``collide:``, ``ghost:``, ``laser: NAME sees WHOM``."""
    pairs: list[tuple[str, str]] = []
    ghosts: list[str] = []
    lasers: list[LaserEntity] = []
    for row in item.picture:
        kind, _, said = row.partition(":")
        if kind == "collide":
            pairs += [(a, b) for a, b in (pair.split("-") for pair in said.split())]
        elif kind == "ghost":
            ghosts += said.split()
        elif kind == "laser":
            name, _, seen = said.partition(" sees ")
            lasers.append(LaserEntity(name.strip(), frozenset(seen.split())))
        else:
            assert row == "all other pairs must not", row
    names = dict.fromkeys([*(name for pair in pairs for name in pair), *ghosts])
    entities = [
        LayerEntity(name, kind="map" if name == "walls" else "bodies", model="" if name == "walls" else name)
        for name in names
        if name not in ghosts
    ]
    entities += [LayerEntity(name, model=name, is_ghost=True) for name in ghosts]
    return LayerCase(tuple(entities), tuple(ContactRequirement(a, b) for a, b in pairs), lasers=tuple(lasers))


def fewest_in_picture(item: QuizItem, folder: Path) -> Finding:
    plan = solve_layers(_case(item))
    assert plan.is_optimal
    return nearest(item, plan.size, 0)


def proof_of_fewest(item: QuizItem, folder: Path) -> Finding:
    """What never contradicts the fewest there are: the certificate, of which no two fit one layer, and not the number
    that the method ends with. (Trying for long cannot be computed: it says nothing of what was not tried.)"""
    plans = {name: solve_layers(case) for name, case in EXAMPLES.items()}
    assert all(plan.is_optimal for plan in plans.values())
    assert any(plan.certificate.bound == plan.size == 3 for plan in plans.values())
    return Finding(
        True,
        {
            "The step-by-step method ended with three": all(
                len(run_greedy(plan.case).assignment.layers) <= plan.size for plan in plans.values()
            ),
            "An hour of trying has found none with two": False,
            "Three requirements, no two of which fit one layer": all(
                plan.certificate.bound <= plan.size for plan in plans.values()
            ),
        },
    )


def greedy_promise(item: QuizItem, folder: Path) -> Finding:
    """Random cases of collisions: does the method's plan always do what is asked, always with the fewest layers?"""
    chance = random.Random(1)
    works, fewest = True, True
    for _ in range(60):
        names = "abcdefgh"
        pairs = [pair for pair in combinations(names, 2) if chance.random() < 0.55]
        case = LayerCase(
            tuple(LayerEntity(name, model=name) for name in names),
            tuple(ContactRequirement(*pair) for pair in pairs),
        )
        assignment = run_greedy(case).assignment
        works = works and not find_breaches(case, assignment)
        fewest = fewest and len(assignment.layers) == solve_layers(case).size
    return Finding(
        (works, fewest),
        {
            "A plan that works and has the fewest layers": (True, True),
            "A plan that works, perhaps with too many layers": (True, False),
            "A plan with few layers that may miss an edge": (False, True),
        },
    )


LAYERS: dict[str, Derivation] = {
    "collisions-in-picture": collisions_in_picture,
    "sight-in-picture": sight_in_picture,
    "robot-and-wall": robot_and_wall,
    "laser-inside-hull": laser_inside_hull,
    "laser-own-wheels": laser_own_wheels,
    "static-crate": static_crate,
    "one-model-two-bodies": one_model_two_bodies,
    "fewest-in-picture": fewest_in_picture,
    "proof-of-fewest": proof_of_fewest,
    "greedy-promise": greedy_promise,
}

"""What a case means, and which cases mean nothing."""

from __future__ import annotations

from typing import Any

import pytest

from kit.layers.requirements import (
    ContactRequirement,
    LaserEntity,
    LayerCase,
    LayerCaseError,
    LayerEntity,
    Relation,
    Sighting,
    SightRequirement,
    layer_conflict,
)
from tests.cases import every_case

HALL, YARD = LayerEntity("hall", "map"), LayerEntity("yard", "map")
ROBOT, ARM, BASE = (
    LayerEntity("robot"),
    LayerEntity("crane.arm", model="crane"),
    LayerEntity("crane.base", model="crane"),
)
CHAIR, LAMP = LayerEntity("chair", model="chair", copies=3), LayerEntity("lamp", is_ghost=True)
THINGS = (HALL, YARD, ROBOT, ARM, BASE, CHAIR, LAMP)


def test_a_contact_has_no_first_and_no_second() -> None:
    assert ContactRequirement("b", "a") == ContactRequirement("a", "b")
    assert len({ContactRequirement("b", "a"), ContactRequirement("a", "b")}) == 1
    assert str(ContactRequirement("b", "a")) == "b - a"  # but is shown as it was written
    assert ContactRequirement("a", "b") != SightRequirement("a", "b")


@every_case(
    ("a", "b", "relation"),
    [
        ("hall", "robot", "collide"),
        ("robot", "hall", "collide"),
        ("robot", "crane.arm", "either"),
        ("robot", "crane.base", "apart"),
        ("hall", "yard", "apart"),
        ("robot", "lamp", "either"),
        ("hall", "lamp", "either"),
        ("robot", "robot", "either"),
        ("chair", "chair", "apart"),
        ("lamp", "lamp", "either"),
    ],
)
def test_what_is_not_mentioned_stays_apart_unless_it_cannot_meet(a: str, b: str, relation: Relation) -> None:
    case = LayerCase(
        THINGS, (ContactRequirement("hall", "robot"),), frozenset({ContactRequirement("crane.arm", "robot")})
    )
    assert case.relation(a, b) == relation


def test_a_laser_is_blind_to_what_it_is_not_said_to_see() -> None:
    laser = LaserEntity("eye", frozenset({"hall"}), frozenset({"robot"}))
    case = LayerCase(THINGS, lasers=(laser,))
    assert [laser.sighting(name) for name in ("hall", "robot", "yard")] == ["sees", "either", "blind"]
    assert case.blind_set(laser) == {"yard", "crane.arm", "crane.base", "chair", "lamp"}


def test_the_requirements_are_the_contacts_as_written_and_then_the_sightings() -> None:
    case = LayerCase(
        THINGS,
        (ContactRequirement("robot", "hall"), ContactRequirement("hall", "crane.arm")),
        lasers=(LaserEntity("eye", frozenset({"robot", "hall"})),),
    )
    assert case.requirements == (
        ContactRequirement("hall", "robot"),
        ContactRequirement("hall", "crane.arm"),
        SightRequirement("eye", "hall"),
        SightRequirement("eye", "robot"),
    )


@every_case(
    ("arguments", "words"),
    [
        ({"entities": (ROBOT, ROBOT)}, "robot"),
        ({"lasers": (LaserEntity("eye"), LaserEntity("eye"))}, "eye"),
        ({"collide": (ContactRequirement("robot", "hall"), ContactRequirement("hall", "robot"))}, "twice"),
        ({"collide": (ContactRequirement("robot", "wall"),)}, "wall"),
        ({"either": frozenset({ContactRequirement("robot", "wall")})}, "wall"),
        ({"lasers": (LaserEntity("eye", frozenset({"wall"})),)}, "wall"),
        ({"lasers": (LaserEntity("eye", frozenset({"hall"}), frozenset({"hall"})),)}, "hall"),
        ({"collide": (ContactRequirement("hall", "yard"),)}, "maps"),
        ({"either": frozenset({ContactRequirement("hall", "yard")})}, "maps"),
        ({"collide": (ContactRequirement("lamp", "hall"),)}, "ghost"),
        (
            {
                "collide": (ContactRequirement("robot", "hall"),),
                "either": frozenset({ContactRequirement("robot", "hall")}),
            },
            "robot - hall",
        ),
        ({"collide": (ContactRequirement("chair", "hall"),)}, "copies of chair"),
        ({"lasers": (LaserEntity("eye", frozenset({"chair"})),)}, "copies of chair"),
    ],
)
def test_a_case_that_means_nothing_is_refused(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(LayerCaseError, match=words):
        LayerCase(**{"entities": THINGS, **arguments})


@pytest.mark.parametrize("relation", ["collide", "either", "apart"])
@pytest.mark.parametrize("before", ["collide", "either", "apart"])
def test_a_relation_can_be_changed_to_any_other(before: Relation, relation: Relation) -> None:
    case = LayerCase(THINGS, (ContactRequirement("robot", "yard"),)).with_relation("robot", "hall", before)
    changed = case.with_relation("hall", "robot", relation)
    assert changed.relation("robot", "hall") == relation
    assert changed.relation("robot", "yard") == "collide"
    assert changed.with_relation("robot", "hall", before) == case


@pytest.mark.parametrize("sighting", ["sees", "either", "blind"])
@pytest.mark.parametrize("before", ["sees", "either", "blind"])
def test_a_sighting_can_be_changed_to_any_other(before: Sighting, sighting: Sighting) -> None:
    case = LayerCase(THINGS, lasers=(LaserEntity("eye"), LaserEntity("ear"))).with_sighting(
        "eye", "hall", before
    )
    changed = case.with_sighting("eye", "hall", sighting)
    assert changed.laser["eye"].sighting("hall") == sighting
    assert changed.laser["ear"] == LaserEntity("ear")
    assert changed.with_sighting("eye", "hall", before) == case


def test_a_case_can_be_built_and_taken_apart_by_hand() -> None:
    empty = LayerCase(())
    case = empty.with_entity(HALL).with_entity(ROBOT).with_laser(LaserEntity("eye"))
    case = case.with_relation("hall", "robot", "collide").with_sighting("eye", "robot", "sees")
    assert case.without_entity("robot") == LayerCase((HALL,), lasers=(LaserEntity("eye"),))
    assert case.without_laser("eye").without_entity("robot").without_entity("hall") == empty


def test_a_requirement_given_up_is_one_that_nobody_minds() -> None:
    case = LayerCase(
        THINGS, (ContactRequirement("robot", "hall"),), lasers=(LaserEntity("eye", frozenset({"hall"})),)
    )
    less = case.without_requirements([ContactRequirement("hall", "robot"), SightRequirement("eye", "hall")])
    assert less.requirements == ()
    assert less.relation("robot", "hall") == "either"
    assert less.laser["eye"].sighting("hall") == "either"


def test_the_slides_switch_frees_the_parts_of_one_model_but_not_its_copies() -> None:
    seats = (
        LayerEntity("chair.seat", model="chair", copies=2),
        LayerEntity("chair.leg", model="chair", copies=2),
    )
    case = LayerCase(
        (*THINGS[:5], *seats),
        (ContactRequirement("crane.arm", "crane.base"), ContactRequirement("crane.arm", "robot")),
    )
    free = case.without_self_collisions()
    assert free.relation("crane.arm", "crane.base") == "either"
    assert free.relation("crane.arm", "robot") == "collide"
    assert free.relation("chair.seat", "chair.leg") == "apart"


@every_case(
    ("one", "other", "reason"),
    [
        (ContactRequirement("hall", "robot"), ContactRequirement("crane.arm", "robot"), None),
        (
            ContactRequirement("hall", "robot"),
            ContactRequirement("crane.base", "robot"),
            "hall and crane.base must not share",
        ),
        (ContactRequirement("hall", "robot"), SightRequirement("eye", "robot"), None),
        (
            ContactRequirement("crane.arm", "robot"),
            SightRequirement("eye", "robot"),
            "eye must not see crane.arm",
        ),
        (SightRequirement("eye", "robot"), SightRequirement("ear", "robot"), None),
        (SightRequirement("eye", "hall"), SightRequirement("ear", "robot"), "ear must not see hall"),
        (SightRequirement("ear", "crane.base"), SightRequirement("ear", "yard"), "must not share"),
    ],
)
def test_two_requirements_fit_one_layer_or_there_is_a_reason(
    one: ContactRequirement | SightRequirement,
    other: ContactRequirement | SightRequirement,
    reason: str | None,
) -> None:
    case = LayerCase(
        THINGS[:5],
        (
            ContactRequirement("hall", "robot"),
            ContactRequirement("crane.arm", "robot"),
            ContactRequirement("crane.base", "robot"),
        ),
        frozenset({ContactRequirement("hall", "crane.arm")}),
        (
            LaserEntity("eye", frozenset({"robot", "hall"})),
            LaserEntity("ear", frozenset({"robot", "crane.base", "yard"})),
        ),
    )
    for found in (layer_conflict(case, one, other), layer_conflict(case, other, one)):
        if reason is None:
            assert found is None
        else:
            assert found is not None
    if reason is not None:
        assert reason in str(layer_conflict(case, one, other))

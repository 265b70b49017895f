"""What a case means, and which cases mean nothing."""

from __future__ import annotations

from typing import Any

import pytest

from kit.layers.requirements import (
    Case,
    CaseError,
    Contact,
    Entity,
    Laser,
    Relation,
    Sight,
    Sighting,
    fit_together,
)

HALL, YARD = Entity("hall", "map"), Entity("yard", "map")
ROBOT, ARM, BASE = Entity("robot"), Entity("crane.arm", model="crane"), Entity("crane.base", model="crane")
CHAIR, LAMP = Entity("chair", model="chair", copies=3), Entity("lamp", ghost=True)
THINGS = (HALL, YARD, ROBOT, ARM, BASE, CHAIR, LAMP)


def test_a_contact_has_no_first_and_no_second() -> None:
    assert Contact("b", "a") == Contact("a", "b")
    assert len({Contact("b", "a"), Contact("a", "b")}) == 1
    assert str(Contact("b", "a")) == "b - a"  # but is shown as it was written
    assert Contact("a", "b") != Sight("a", "b")


@pytest.mark.parametrize(
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
    case = Case(THINGS, (Contact("hall", "robot"),), frozenset({Contact("crane.arm", "robot")}))
    assert case.relation(a, b) == relation


def test_a_laser_is_blind_to_what_it_is_not_said_to_see() -> None:
    laser = Laser("eye", frozenset({"hall"}), frozenset({"robot"}))
    case = Case(THINGS, lasers=(laser,))
    assert [laser.sighting(name) for name in ("hall", "robot", "yard")] == ["sees", "either", "blind"]
    assert case.blind(laser) == {"yard", "crane.arm", "crane.base", "chair", "lamp"}


def test_the_requirements_are_the_contacts_as_written_and_then_the_sightings() -> None:
    case = Case(
        THINGS,
        (Contact("robot", "hall"), Contact("hall", "crane.arm")),
        lasers=(Laser("eye", frozenset({"robot", "hall"})),),
    )
    assert case.requirements == (
        Contact("hall", "robot"),
        Contact("hall", "crane.arm"),
        Sight("eye", "hall"),
        Sight("eye", "robot"),
    )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"entities": (ROBOT, ROBOT)}, "robot"),
        ({"lasers": (Laser("eye"), Laser("eye"))}, "eye"),
        ({"collide": (Contact("robot", "hall"), Contact("hall", "robot"))}, "twice"),
        ({"collide": (Contact("robot", "wall"),)}, "wall"),
        ({"either": frozenset({Contact("robot", "wall")})}, "wall"),
        ({"lasers": (Laser("eye", frozenset({"wall"})),)}, "wall"),
        ({"lasers": (Laser("eye", frozenset({"hall"}), frozenset({"hall"})),)}, "hall"),
        ({"collide": (Contact("hall", "yard"),)}, "maps"),
        ({"either": frozenset({Contact("hall", "yard")})}, "maps"),
        ({"collide": (Contact("lamp", "hall"),)}, "ghost"),
        (
            {"collide": (Contact("robot", "hall"),), "either": frozenset({Contact("robot", "hall")})},
            "robot - hall",
        ),
        ({"collide": (Contact("chair", "hall"),)}, "copies of chair"),
        ({"lasers": (Laser("eye", frozenset({"chair"})),)}, "copies of chair"),
    ],
)
def test_a_case_that_means_nothing_is_refused(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(CaseError, match=words):
        Case(**{"entities": THINGS, **arguments})


@pytest.mark.parametrize("relation", ["collide", "either", "apart"])
@pytest.mark.parametrize("before", ["collide", "either", "apart"])
def test_a_relation_can_be_changed_to_any_other(before: Relation, relation: Relation) -> None:
    case = Case(THINGS, (Contact("robot", "yard"),)).with_relation("robot", "hall", before)
    changed = case.with_relation("hall", "robot", relation)
    assert changed.relation("robot", "hall") == relation
    assert changed.relation("robot", "yard") == "collide"
    assert changed.with_relation("robot", "hall", before) == case


@pytest.mark.parametrize("sighting", ["sees", "either", "blind"])
@pytest.mark.parametrize("before", ["sees", "either", "blind"])
def test_a_sighting_can_be_changed_to_any_other(before: Sighting, sighting: Sighting) -> None:
    case = Case(THINGS, lasers=(Laser("eye"), Laser("ear"))).with_sighting("eye", "hall", before)
    changed = case.with_sighting("eye", "hall", sighting)
    assert changed.laser["eye"].sighting("hall") == sighting
    assert changed.laser["ear"] == Laser("ear")
    assert changed.with_sighting("eye", "hall", before) == case


def test_a_case_can_be_built_and_taken_apart_by_hand() -> None:
    empty = Case(())
    case = empty.with_entity(HALL).with_entity(ROBOT).with_laser(Laser("eye"))
    case = case.with_relation("hall", "robot", "collide").with_sighting("eye", "robot", "sees")
    assert case.without_entity("robot") == Case((HALL,), lasers=(Laser("eye"),))
    assert case.without_laser("eye").without_entity("robot").without_entity("hall") == empty


def test_a_requirement_given_up_is_one_that_nobody_minds() -> None:
    case = Case(THINGS, (Contact("robot", "hall"),), lasers=(Laser("eye", frozenset({"hall"})),))
    less = case.without([Contact("hall", "robot"), Sight("eye", "hall")])
    assert less.requirements == ()
    assert less.relation("robot", "hall") == "either"
    assert less.laser["eye"].sighting("hall") == "either"


def test_the_slides_switch_frees_the_parts_of_one_model_but_not_its_copies() -> None:
    seats = (Entity("chair.seat", model="chair", copies=2), Entity("chair.leg", model="chair", copies=2))
    case = Case((*THINGS[:5], *seats), (Contact("crane.arm", "crane.base"), Contact("crane.arm", "robot")))
    free = case.with_one_model_free()
    assert free.relation("crane.arm", "crane.base") == "either"
    assert free.relation("crane.arm", "robot") == "collide"
    assert free.relation("chair.seat", "chair.leg") == "apart"


@pytest.mark.parametrize(
    ("one", "other", "reason"),
    [
        (Contact("hall", "robot"), Contact("crane.arm", "robot"), None),
        (Contact("hall", "robot"), Contact("crane.base", "robot"), "hall and crane.base must not share"),
        (Contact("hall", "robot"), Sight("eye", "robot"), None),
        (Contact("crane.arm", "robot"), Sight("eye", "robot"), "eye must not see crane.arm"),
        (Sight("eye", "robot"), Sight("ear", "robot"), None),
        (Sight("eye", "hall"), Sight("ear", "robot"), "ear must not see hall"),
        (Sight("ear", "crane.base"), Sight("ear", "yard"), "must not share"),
    ],
)
def test_two_requirements_fit_one_layer_or_there_is_a_reason(
    one: Contact | Sight, other: Contact | Sight, reason: str | None
) -> None:
    case = Case(
        THINGS[:5],
        (
            Contact("hall", "robot"),
            Contact("crane.arm", "robot"),
            Contact("crane.base", "robot"),
        ),
        frozenset({Contact("hall", "crane.arm")}),
        (
            Laser("eye", frozenset({"robot", "hall"})),
            Laser("ear", frozenset({"robot", "crane.base", "yard"})),
        ),
    )
    for found in (fit_together(case, one, other), fit_together(case, other, one)):
        if reason is None:
            assert found is None
        else:
            assert found is not None
    if reason is not None:
        assert reason in str(fit_together(case, one, other))

"""Which lists of layers a world has, and what each decides."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.layers.flatland.layer_lists import read_world, slots_of
from kit.world.problems import WorldError
from tests.layers.conftest import YARD, WriteFiles


def test_a_list_that_two_instances_share_is_one_slot(yard: Path) -> None:
    slots = slots_of(read_world(yard))
    chair = next(slot for slot in slots.bodies if slot.place.file.name == "chair.model.yaml")
    assert chair.models == ("chair1", "chair2")
    assert [spot.address for spot in chair.spots] == ["chair1/seat[0]", "chair2/seat[0]"]
    assert chair.written == ("both", "fence")
    assert [slot.spots[0].address for slot in slots.maps] == ["walls of solid", "walls of fence"]
    assert [(laser.plugin, laser.written) for laser in slots.lasers] == [
        ("lidar", ("seen",)),
        ("eye", ("tracked",)),
    ]


def test_who_can_meet_whom_is_flatlands_rule(yard: Path) -> None:
    slots = slots_of(read_world(yard))
    spots = {spot.address: spot for slot in (*slots.maps, *slots.bodies) for spot in slot.spots}
    base, bumper, chair = spots["robot/base[0]"], spots["robot/bumper[0]"], spots["chair1/seat[0]"]
    assert slots.can_meet(base, chair)
    assert slots.can_meet(chair, spots["chair2/seat[0]"])
    assert not slots.can_meet(base, bumper)  # joined
    assert "fix" in slots.why_not(base, bumper)
    assert not slots.can_meet(spots["beacon/post[0]"], spots["walls of solid"])  # neither moves
    lidar = slots.lasers[0].uses[0]
    assert not slots.can_see(lidar, base)  # its rays start inside
    assert slots.can_see(lidar, bumper)
    assert slots.can_see(lidar, spots["walls of fence"])


def test_the_slides_assumption_is_a_switch(write: WriteFiles) -> None:
    loose = YARD["robot.model.yaml"].replace("joints:", "#").replace("  - {name: fix", "#")
    world = read_world(write({"robot.model.yaml": loose}))
    meets = []
    for never in (False, True):
        slots = slots_of(world, one_model_never_collides=never)
        base, bumper = (slot.spots[0] for slot in slots.bodies[:2])
        meets.append(slots.can_meet(base, bumper))
    assert meets == [True, False]


def test_a_plugin_nobody_knows_is_let_pass_and_a_broken_laser_is_not(write: WriteFiles) -> None:
    odd = YARD["chair.model.yaml"] + "plugins:\n  - {type: Teapot, name: t, whatever: [1]}\n"
    assert slots_of(read_world(write({"chair.model.yaml": odd}))).lasers
    broken = YARD["beacon.model.yaml"].replace("[tracked]", "[trackd]")
    with pytest.raises(WorldError, match='did you mean "tracked"'):
        read_world(write({"beacon.model.yaml": broken}))


def test_the_reflectance_layer_is_kept(write: WriteFiles) -> None:
    shining = YARD["world.yaml"].replace("name: spare", "name: reflectance")
    slots = slots_of(read_world(write({"world.yaml": shining})))
    assert slots.kept == ("reflectance",)
    assert slots_of(read_world(write({}))).kept == ()

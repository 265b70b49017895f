"""Which lists of layers a world has, and what each decides."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.world.problems import WorldError
from tests.layers.conftest import YARD, WriteFiles


def test_a_list_that_two_instances_share_is_one_slot(yard: Path) -> None:
    slots = find_layer_lists(read_world_layers(yard))
    chair = next(slot for slot in slots.bodies if slot.location.file.name == "chair.model.yaml")
    assert chair.models == ("chair1", "chair2")
    assert [spot.address for spot in chair.uses] == ["chair1/seat[0]", "chair2/seat[0]"]
    assert chair.names == ("both", "fence")
    assert [slot.uses[0].address for slot in slots.maps] == ["walls of solid", "walls of fence"]
    assert [(laser.plugin, laser.names) for laser in slots.lasers] == [
        ("lidar", ("seen",)),
        ("eye", ("tracked",)),
    ]


def test_who_can_meet_whom_is_flatlands_rule(yard: Path) -> None:
    slots = find_layer_lists(read_world_layers(yard))
    spots = {spot.address: spot for slot in (*slots.maps, *slots.bodies) for spot in slot.uses}
    base, bumper, chair = spots["robot/base[0]"], spots["robot/bumper[0]"], spots["chair1/seat[0]"]
    assert slots.can_collide(base, chair)
    assert slots.can_collide(chair, spots["chair2/seat[0]"])
    assert not slots.can_collide(base, bumper)  # joined
    assert "fix" in slots.no_contact_reason(base, bumper)
    assert not slots.can_collide(spots["beacon/post[0]"], spots["walls of solid"])  # neither moves
    lidar = slots.lasers[0].uses[0]
    assert not slots.can_see(lidar, base)  # its rays start inside
    assert slots.can_see(lidar, bumper)
    assert slots.can_see(lidar, spots["walls of fence"])


def test_the_slides_assumption_is_a_switch(write: WriteFiles) -> None:
    loose = YARD["robot.model.yaml"].replace("joints:", "#").replace("  - {name: fix", "#")
    world = read_world_layers(write({"robot.model.yaml": loose}))
    meets = []
    for never in (False, True):
        slots = find_layer_lists(world, one_model_never_collides=never)
        base, bumper = (slot.uses[0] for slot in slots.bodies[:2])
        meets.append(slots.can_collide(base, bumper))
    assert meets == [True, False]


def test_a_plugin_nobody_knows_is_let_pass_and_a_broken_laser_is_not(write: WriteFiles) -> None:
    odd = YARD["chair.model.yaml"] + "plugins:\n  - {type: Teapot, name: t, whatever: [1]}\n"
    assert find_layer_lists(read_world_layers(write({"chair.model.yaml": odd}))).lasers
    broken = YARD["beacon.model.yaml"].replace("[tracked]", "[trackd]")
    with pytest.raises(WorldError, match='did you mean "tracked"'):
        read_world_layers(write({"beacon.model.yaml": broken}))


def test_the_reflectance_layer_is_kept(write: WriteFiles) -> None:
    shining = YARD["world.yaml"].replace("name: spare", "name: reflectance")
    slots = find_layer_lists(read_world_layers(write({"world.yaml": shining})))
    assert slots.kept_layers == ("reflectance",)
    assert find_layer_lists(read_world_layers(write({}))).kept_layers == ()

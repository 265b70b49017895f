"""Which lists of layers a world has, and what each decides."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.world.problems import WorldError
from tests.layers.conftest import YARD, WriteFiles


def test_a_list_that_two_instances_share_is_one_slot(yard: Path) -> None:
    layer_lists = find_layer_lists(read_world_layers(yard))
    chair = next(
        layer_list for layer_list in layer_lists.bodies if layer_list.location.file.name == "chair.model.yaml"
    )
    assert chair.models == ("chair1", "chair2")
    assert [use.address for use in chair.uses] == ["chair1/seat[0]", "chair2/seat[0]"]
    assert chair.names == ("both", "fence")
    assert [layer_list.uses[0].address for layer_list in layer_lists.maps] == [
        "walls of solid",
        "walls of fence",
    ]
    assert [(laser.plugin, laser.names) for laser in layer_lists.lasers] == [
        ("lidar", ("seen",)),
        ("eye", ("tracked",)),
    ]


def test_who_can_meet_whom_is_flatlands_rule(yard: Path) -> None:
    layer_lists = find_layer_lists(read_world_layers(yard))
    uses = {
        use.address: use for layer_list in (*layer_lists.maps, *layer_lists.bodies) for use in layer_list.uses
    }
    base, bumper, chair = uses["robot/base[0]"], uses["robot/bumper[0]"], uses["chair1/seat[0]"]
    assert layer_lists.can_collide(base, chair)
    assert layer_lists.can_collide(chair, uses["chair2/seat[0]"])
    assert not layer_lists.can_collide(base, bumper)  # joined
    assert "fix" in layer_lists.no_contact_reason(base, bumper)
    assert not layer_lists.can_collide(uses["beacon/post[0]"], uses["walls of solid"])  # neither moves
    lidar = layer_lists.lasers[0].uses[0]
    assert not layer_lists.can_see(lidar, base)  # its rays start inside
    assert layer_lists.can_see(lidar, bumper)
    assert layer_lists.can_see(lidar, uses["walls of fence"])


def test_the_slides_assumption_is_a_switch(write: WriteFiles) -> None:
    loose = YARD["robot.model.yaml"].replace("joints:", "#").replace("  - {name: fix", "#")
    world = read_world_layers(write({"robot.model.yaml": loose}))
    meets = []
    for never in (False, True):
        layer_lists = find_layer_lists(world, one_model_never_collides=never)
        base, bumper = (layer_list.uses[0] for layer_list in layer_lists.bodies[:2])
        meets.append(layer_lists.can_collide(base, bumper))
    assert meets == [True, False]


def test_a_plugin_nobody_knows_is_let_pass_and_a_broken_laser_is_not(write: WriteFiles) -> None:
    odd = YARD["chair.model.yaml"] + "plugins:\n  - {type: Teapot, name: t, whatever: [1]}\n"
    assert find_layer_lists(read_world_layers(write({"chair.model.yaml": odd}))).lasers
    broken = YARD["beacon.model.yaml"].replace("[tracked]", "[trackd]")
    with pytest.raises(WorldError, match='did you mean "tracked"'):
        read_world_layers(write({"beacon.model.yaml": broken}))


def test_the_reflectance_layer_is_kept(write: WriteFiles) -> None:
    shining = YARD["world.yaml"].replace("name: spare", "name: reflectance")
    layer_lists = find_layer_lists(read_world_layers(write({"world.yaml": shining})))
    assert layer_lists.kept_layers == ("reflectance",)
    assert find_layer_lists(read_world_layers(write({}))).kept_layers == ()

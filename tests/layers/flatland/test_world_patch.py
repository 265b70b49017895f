"""Plans written into files: previewed, applied as one, checked, and taken back when anything is wrong."""

from __future__ import annotations

import random
import shutil
from pathlib import Path

import pytest

from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.layers.flatland.requirement_binding import bind_requirements
from kit.layers.flatland.world_case import current_case
from kit.layers.flatland.world_patch import (
    PatchError,
    WorldPatch,
    apply_patch,
    behaviour_differences,
    build_patch,
    make_recheck,
)
from kit.layers.flatland.world_planning import WorldPlan, plan_world
from kit.layers.requirements_file import read_requirements
from kit.workspace import write_atomically
from tests.layers.conftest import YARD, WriteFiles
from tests.layers.flatland.test_world_planning import FLATLAND
from tests.layers.worlds import random_world

DIFF = """\
-        layers: ["both", "fence"]   # not the robot's
+        layers: [fence, solid]   # not the robot's
-        layers: [solid, both, tracked]
+        layers: [solid, tracked]
-      - {type: circle, center: [0.3, 0], radius: 0.05, density: 1, layers: [solid, both, tracked]}  # in front
+      - {type: circle, center: [0.3, 0], radius: 0.05, density: 1, layers: [solid, tracked]}  # in front
-  - name: [solid, seen, both]     # what robots touch, what lasers see
+  - name: [solid, seen]     # what robots touch, what lasers see
-  - name: spare
"""


def planned(world: Path) -> WorldPlan:
    return plan_world(current_case(find_layer_lists(read_world_layers(world))))


def contents(world: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in world.parent.iterdir()}


def applied(world: Path, plan: WorldPlan, patch: WorldPatch) -> None:
    apply_patch(patch, make_recheck(plan, lambda: read_world_layers(world)))


def changed_lines(patch: WorldPatch) -> list[str]:
    lines = patch.diff().splitlines(keepends=True)
    return [line for line in lines if line[0] in "+-" and not line.startswith(("+++", "---"))]


def test_the_diff_shows_what_changes_and_nothing_else(yard: Path) -> None:
    before = contents(yard)
    patch = build_patch(planned(yard))
    assert "".join(changed_lines(patch)) == DIFF
    assert patch.skipped == ()
    assert contents(yard) == before


def test_applied_the_world_does_the_same_with_as_many_layers_as_planned(yard: Path) -> None:
    plan, before = planned(yard), read_world_layers(yard)
    applied(yard, plan, build_patch(plan))
    after = read_world_layers(yard)
    assert len(after.layer_bits) == 4
    assert behaviour_differences(before, after) == []
    again = planned(yard)
    assert again.is_unchanged
    assert build_patch(again) == WorldPatch((), ())


@pytest.mark.parametrize("seed", range(80))
def test_any_world_is_patched_right_or_not_at_all(write: WriteFiles, seed: int) -> None:
    world = write(random_world(random.Random(seed)))
    plan, before = planned(world), read_world_layers(world)
    patch = build_patch(plan)
    assert patch.skipped == ()
    applied(world, plan, patch)
    after = read_world_layers(world)
    assert behaviour_differences(before, after) == []
    assert len(after.layer_bits) == plan.size
    comments = [text.count("#") for text in map(bytes.decode, contents(world).values())]
    assert sum(comments) >= sum(file.before.decode().count("#") for file in patch.files) - sum(
        line.startswith("-  - ") for line in changed_lines(patch)
    )  # an entry that goes takes its own along


def test_flatlands_own_world_is_patched_right(tmp_path: Path) -> None:
    if not FLATLAND.is_dir():
        pytest.skip(f"Flatland's own worlds are not here: {FLATLAND}")
    folder = tmp_path / "world"
    shutil.copytree(FLATLAND / "flatland_server/test/load_world_tests/simple_test_A", folder)
    world = folder / "world.yaml"
    plan, before = planned(world), read_world_layers(world)
    applied(world, plan, build_patch(plan))
    assert behaviour_differences(before, read_world_layers(world)) == []
    assert list(read_world_layers(world).layer_bits) == ["2d", "3d", "lines"]


def test_new_wishes_are_written_and_checked(yard: Path) -> None:
    """The robot shall no longer be stopped by chairs, and the beacon shall see both."""
    asked = yard.with_name("asked.yaml")
    asked.write_text(
        "maps: [solid, fence]\nmodels: [robot, chair, beacon]\ncopies: {chair: [chair1, chair2]}\n"
        "collide:\n  solid: [robot, chair]\n  fence: [chair]\n  chair: [chair]\n"
        "lasers:\n  lidar: [solid, fence]\n  eye: [robot, chair]\n"
    )
    requirements = read_requirements(asked)
    plan = plan_world(bind_requirements(requirements, find_layer_lists(read_world_layers(yard))))
    apply_patch(
        build_patch(plan), make_recheck(plan, lambda: read_world_layers(yard), requirements=requirements)
    )
    assert bind_requirements(requirements, find_layer_lists(read_world_layers(yard))).current_breaches == ()


@pytest.mark.parametrize(
    ("name", "old", "new", "reason"),
    [
        (
            "robot.model.yaml",
            "[solid, both, tracked]\n",
            "[solid, # c\n          both, tracked]\n",
            "comments",
        ),
        ("robot.model.yaml", "[solid, both, tracked]\n", "&l [solid, both, tracked]\n", "anchor"),
        ("world.yaml", "  - name: [solid", "  - name: !!seq [solid", "tag"),
    ],
)
def test_a_file_that_cannot_be_patched_safely_is_left_alone_and_so_are_the_others(
    write: WriteFiles, name: str, old: str, new: str, reason: str
) -> None:
    assert old in YARD[name]
    world = write({name: YARD[name].replace(old, new, 1)})
    before, plan = contents(world), planned(world)
    patch = build_patch(plan)
    (left,) = patch.skipped
    assert left.path.name == name
    assert reason in left.reason
    assert left.by_hand
    assert all(name in words for words in left.by_hand)
    with pytest.raises(PatchError, match="by hand"):
        applied(world, plan, patch)
    assert contents(world) == before


def test_a_model_that_another_world_names_is_left_alone_unless_asked(yard: Path) -> None:
    other = yard.with_name("other.world.yaml")
    other.write_text("properties: {}\nlayers: []\nmodels:\n  - {name: c, model: chair.model.yaml}\n")
    plan = planned(yard)
    (left,) = build_patch(plan).skipped
    assert left.path.name == "chair.model.yaml"
    assert str(other) in left.reason
    assert build_patch(plan, also_shared=True).skipped == ()


def test_a_layer_called_all_cannot_be_named_alone(write: WriteFiles) -> None:
    files = {name: text.replace("solid", "all") for name, text in YARD.items()}
    world = write(
        {**files, "chair.model.yaml": files["chair.model.yaml"].replace('["both", "fence"]', "[both]")}
    )
    patch = build_patch(planned(world))
    assert [left.path.name for left in patch.skipped] == ["chair.model.yaml"]
    assert '"all"' in patch.skipped[0].reason


def test_a_file_changed_meanwhile_is_not_written_over(yard: Path) -> None:
    plan = planned(yard)
    patch = build_patch(plan)
    world = yard.read_bytes() + b"# mine\n"
    yard.write_bytes(world)
    before = contents(yard)
    with pytest.raises(PatchError, match="changed since"):
        applied(yard, plan, patch)
    assert contents(yard) == before


def test_a_result_that_is_not_what_was_asked_is_taken_back(yard: Path) -> None:
    before, patch = contents(yard), build_patch(planned(yard))
    with pytest.raises(PatchError, match="no longer sees"):
        apply_patch(patch, lambda: ["the lidar no longer sees the walls"])
    assert contents(yard) == before


@pytest.mark.parametrize("failing", [1, 2, 3])
def test_a_write_that_fails_half_way_leaves_every_file_as_it_was(
    yard: Path, monkeypatch: pytest.MonkeyPatch, failing: int
) -> None:
    before, plan = contents(yard), planned(yard)
    patch = build_patch(plan)
    assert len(patch.files) == 3
    count = 0

    def flaky(path: Path, content: bytes) -> None:
        nonlocal count
        count += 1
        if count == failing:
            raise OSError(28, "No space left on device")
        write_atomically(path, content)

    monkeypatch.setattr("kit.layers.flatland.world_patch.write_atomically", flaky)
    with pytest.raises(PatchError, match="No space"):
        applied(yard, plan, patch)
    assert contents(yard) == before


def test_line_ends_byte_order_mark_and_permissions_stay(write: WriteFiles) -> None:
    world = write({"world.yaml": ("\ufeff" + YARD["world.yaml"].replace("\n", "\r\n")).encode()})
    world.chmod(0o640)
    plan = planned(world)
    applied(world, plan, build_patch(plan))
    content = world.read_bytes()
    assert content.startswith("\ufeff".encode())
    assert content.count(b"\n") == content.count(b"\r\n") > 10
    assert world.stat().st_mode & 0o777 == 0o640


def test_differences_are_named(yard: Path, write: WriteFiles) -> None:
    before = read_world_layers(yard)
    after = read_world_layers(
        write({"beacon.model.yaml": YARD["beacon.model.yaml"].replace("[tracked]", "[seen]")})
    )
    assert behaviour_differences(before, after) == [
        "beacon/eye sees walls of solid",
        "beacon/eye no longer sees robot/base",
        "beacon/eye no longer sees robot/bumper",
    ]

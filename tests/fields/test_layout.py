"""Layouts: those beside maps, bad ones, and those made from walls."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from kit.fields.charge_derivation import derive_charges, layout_differences
from kit.fields.charges import CompositeCharge, LineCharge, PointCharge, iter_members
from kit.fields.layout import LAYOUT_FILE, Intensities, derived_layout, load_layout, read_layout
from kit.fields.occupancy_grid import OccupancyGrid, load_occupancy_grid
from kit.world.problems import WorldError
from tests.kit_content import kit_maps

CARDS = {card.name: card for card in kit_maps()}
DRAWN = sorted(name for name, card in CARDS.items() if (card.folder / LAYOUT_FILE).is_file())
GOOD = "intensities: {walls: -1, target: 15}\n"


def grid(name: str) -> OccupancyGrid:
    return load_occupancy_grid(CARDS[name].world_file)[1]


def box(*walls: tuple[float, float, float, float], inside: tuple[float, float]) -> OccupancyGrid:
    return OccupancyGrid.from_walls(np.array(walls, dtype=float), [inside])


def problems(tmp_path: Path, text: str) -> list[str]:
    file = tmp_path / LAYOUT_FILE
    file.write_text(text)
    with pytest.raises(WorldError) as error:
        read_layout(file, grid("pair_turn"))
    return [str(problem).removeprefix(f"{file}:") for problem in error.value.problems]


def test_tutorial_3_as_its_author_drew_it() -> None:
    layout = load_layout(CARDS["pair_turn"].world_file, grid("pair_turn"))
    assert layout.intensities == Intensities(walls=-1, target=15, robot=-1, tension=100)
    lines = [charge for charge in layout.charges if isinstance(charge, LineCharge)]
    (composite,) = (charge for charge in layout.charges if isinstance(charge, CompositeCharge))
    assert len(lines) == 4
    assert composite.points == (PointCharge(0.42, 1.22),)
    # In the middle of the upright corridor: 0.42 m to both sides, which cancel, and (0.8 m) from the end behind.
    assert layout.wall_forces((0.0, 0.58)) == pytest.approx([0, 1 / 0.8**2 - 1 / 1.43**2])
    assert layout.forces((0.0, 0.58), (0.0, 1.58)) == pytest.approx([0, 15 + 1 / 0.8**2 - 1 / 1.43**2])


@pytest.mark.parametrize("name", DRAWN)
def test_a_layout_drawn_by_hand_says_what_the_walls_say_to_the_centimetre(name: str) -> None:
    ground = grid(name)
    layout = load_layout(CARDS[name].world_file, ground)
    said = layout_differences(layout.charges, derive_charges(ground))
    assert all("0.010 m off" in each for each in said)
    assert len(said) == (3 if name == "pair_turn" else 0)


@pytest.mark.parametrize("name", CARDS)
def test_every_map_has_a_layout_that_pushes_off_its_walls(name: str) -> None:
    ground = grid(name)
    layout = derived_layout(ground)
    near = ground.inside & (ground.clearance < 0.06) & (ground.clearance > 0.03)
    rows, columns = np.gradient(ground.clearance)
    forces = layout.wall_forces(ground.cell_centers[near])
    outwards = forces[:, 0] * columns[near] + forces[:, 1] * rows[near]
    assert (outwards > -1e-6).mean() > 0.97


def test_a_pillar_is_one_composite_of_four_lines_and_four_corners() -> None:
    room = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]
    pillar = [(1, 1, 2, 1), (2, 1, 2, 2), (2, 2, 1, 2), (1, 2, 1, 1)]
    charges = derive_charges(box(*room, *pillar, inside=(3, 3)))
    (composite,) = (charge for charge in charges if isinstance(charge, CompositeCharge))
    assert (len(composite.lines), len(composite.points)) == (4, 4)
    assert len(charges) == 5
    # Seen from a corner's diagonal, the corner acts: sqrt(2) m away.
    assert np.hypot(*composite.force((3, 3))) == pytest.approx(0.5)


def test_a_slanting_wall_that_ends_in_the_room_has_corners_at_its_ends() -> None:
    room = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]
    charges = derive_charges(box(*room, (1, 1, 2, 2), inside=(3, 1)))
    (composite,) = (charge for charge in charges if isinstance(charge, CompositeCharge))
    assert {(point.x, point.y) for point in composite.points} == {(1, 1), (2, 2)}


def test_walls_that_look_onto_nothing_but_the_outside_get_no_charge() -> None:
    inner = [(0, 0, 2, 0), (2, 0, 2, 2), (2, 2, 0, 2), (0, 2, 0, 0)]
    outer = [(-0.1, -0.1, 2.1, -0.1), (2.1, -0.1, 2.1, 2.1), (2.1, 2.1, -0.1, 2.1), (-0.1, 2.1, -0.1, -0.1)]
    assert len(list(iter_members(derive_charges(box(*inner, *outer, inside=(1, 1)))))) == 4


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("charges: []\n", ['1:1: "intensities" is missing']),
        ("intensities: {walls: -1}\ncharges: []\n", ['1:14: "target" is missing']),
        ("intensities: {target: -3}\ncharges: []\n", ["1:23: the target must attract"]),
        ("intensities: {targe: 3}\ncharges: []\n", ['1:14: "target" is missing', '1:15: unknown key "targe": did you mean']),
        (f"{GOOD}charges:\n  - line: [0, 0, 0, 0]\n", ["3:11: the line has no length"]),
        (f"{GOOD}charges:\n  - point: [0.46, 0.5]\n", ["3:12: the charge is inside a wall: [0.46, 0.5] is 0.04 m"]),
        (f"{GOOD}charges:\n  - line: [0.46, 0.0, 0.46, 1.0]\n", ["3:11: the charge is inside a wall"]),
        (f"{GOOD}charges:\n  - tension: [0, 0]\n", ["3:5: a charge must be one of: line, point, composite", "3:5: unknown"]),
        (f"{GOOD}charges:\n  - line: [0, 0, one, 1]\n", ['3:18: "line"[2] must be a number']),
        (
            f"{GOOD}charges:\n  - composite:\n      - line: [0.42, 0, 0.42, 1.22]\n      - line: [0.42, 1.22, 1.82, 1.22]\n",
            ["the composite is open: the line", "the composite is open: the line", "there is no point there"],
        ),
        (
            f"{GOOD}charges:\n  - composite:\n      - line: [0.42, 0, 0.42, 1.22]\n      - point: [0.42, 1.22]\n    handover: last\n",
            ['6:15: "handover" cannot be "last"'],
        ),
    ],
)  # fmt: skip
def test_bad_layouts_are_explained_at_their_place(tmp_path: Path, text: str, said: list[str]) -> None:
    found = problems(tmp_path, text)
    for wanted in said:
        assert any(wanted in problem for problem in found), found


def test_all_mistakes_come_at_once(tmp_path: Path) -> None:
    text = "intensities: {walls: much, target: 15}\ncharges:\n  - line: [0, 0, 0, 0]\n  - point: [1]\n    times: x\n"
    assert len(problems(tmp_path, text)) == 4


def test_an_intensity_scales_the_field_without_a_new_one() -> None:
    layout = derived_layout(grid("pair_turn"))
    stronger = layout.with_intensities(Intensities(walls=-3))
    assert stronger.field is layout.field
    assert stronger.wall_forces((0.1, 0.3)) == pytest.approx(3 * layout.wall_forces((0.1, 0.3)))


def test_a_charge_may_count_for_more(tmp_path: Path) -> None:
    (tmp_path / LAYOUT_FILE).write_text(f"{GOOD}charges:\n  - point: [0, 0]\n    times: 2\n")
    assert read_layout(tmp_path / LAYOUT_FILE).wall_forces((1, 0)) == pytest.approx([2, 0])

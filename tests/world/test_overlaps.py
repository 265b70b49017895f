from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kit.world.loading import load_world
from kit.world.problems import WorldError

ROOM = "type: line_segments\ndata: room.dat\nscale: 1\norigin: [0, 0, 0]\n"
SQUARE = "0 0 40 0\n40 0 40 40\n40 40 0 40\n0 40 0 0\n"
ROBOT = "bodies: [{name: base, footprints: [{type: circle, radius: 0.2, density: 1, layers: [solid]}]}]\n"
PLANK = """bodies:
- name: base
  footprints: [{type: polygon, points: [[-1, -0.1], [1, -0.1], [1, 0.1], [-1, 0.1]], density: 1, layers: [solid]}]
"""


def _world(folder: Path, walls: str, places: list[tuple[float, float]], *, model: str = ROBOT) -> Path:
    (folder / "room.yaml").write_text(ROOM)
    (folder / "room.dat").write_text(walls)
    (folder / "robot.model.yaml").write_text(model)
    models = (
        f"- {{name: r{n}, model: robot.model.yaml, pose: [{x}, {y}, 0]}}" for n, (x, y) in enumerate(places)
    )
    file = folder / "world.yaml"
    file.write_text(
        "properties: {}\nlayers: [{name: solid, map: room.yaml}]\nmodels:\n" + "\n".join(models or ["[]"])
    )
    return file


def _fan(count: int) -> Iterator[str]:
    """Walls through the middle of a square, no two alike."""
    return (f"0 {4 * n / count} 4 {4 - 4 * n / count}" for n in range(count))


def _short_walls(count: int) -> Iterator[str]:
    """Walls that do not touch one another."""
    return (f"{n % 300} {n // 300} {n % 300 + 0.5} {n // 300 + 0.5}" for n in range(count))


@pytest.mark.parametrize(
    ("walls", "places", "model", "what"),
    [
        pytest.param(lambda: ["0 0 4 4"] * 7000, [(30, 30)], ROBOT, "pairs of walls", id="one wall many times"),
        pytest.param(lambda: _fan(7000), [(30, 30)], ROBOT, "pairs of walls", id="a fan of walls"),
        pytest.param(
            lambda: [*_short_walls(30_000), *["0 0 4 4"] * 9000], [(30, 30)], ROBOT, "pairs of walls", id="among others"
        ),
        pytest.param(list, [(1, 1)] * 300, ROBOT, "pairs of footprints", id="robots on top of one another"),
        pytest.param(
            list, [(n / 300, 1) for n in range(300)], PLANK, "pairs of footprints", id="planks on one another"
        ),
        pytest.param(
            lambda: ["1 1 1.1 1.1"] * 2000,
            [(1 + n / 80, 1) for n in range(60)],
            PLANK,
            "a footprint and a wall",
            id="all on all walls",
        ),
    ],
)  # fmt: skip
def test_what_lies_on_top_of_itself_is_refused(
    walls: Callable[[], Iterator[str]],
    places: list[tuple[float, float]],
    model: str,
    what: str,
    tmp_path: Path,
) -> None:
    with pytest.raises(WorldError) as error:
        load_world(_world(tmp_path, SQUARE + "\n".join(walls()), places, model=model))
    assert [what in str(each) for each in error.value.problems] == [True]


@pytest.mark.parametrize(
    ("walls", "places", "model"),
    [
        pytest.param(lambda: _short_walls(60_000), [(30, 30)], ROBOT, id="many short walls"),
        pytest.param(lambda: _fan(1000), [(30, 30)], ROBOT, id="a thousand walls that cross"),
        pytest.param(list, [(n % 50, n // 50) for n in range(2000)], ROBOT, id="many robots apart"),
        pytest.param(list, [(1, 1)] * 100, ROBOT, id="a hundred robots at one start"),
    ],
)
def test_a_large_world_is_read(
    walls: Callable[[], Iterator[str]], places: list[tuple[float, float]], model: str, tmp_path: Path
) -> None:
    assert len(load_world(_world(tmp_path, SQUARE + "\n".join(walls()), places, model=model)).models) == len(
        places
    )


def test_a_world_with_too_many_bodies_is_refused(tmp_path: Path) -> None:
    bodies = ", ".join(f"{{name: b{n}, footprints: []}}" for n in range(1200))
    with pytest.raises(WorldError, match="10,800 bodies"):
        load_world(_world(tmp_path, SQUARE, [(n, 1) for n in range(9)], model=f"bodies: [{bodies}]\n"))


@pytest.mark.long
def test_a_checkerboard_of_as_many_pixels_as_a_picture_may_have_is_read(tmp_path: Path) -> None:
    """Its walls cross one another, which costs the engine a second, once."""
    rows, columns = np.indices((4096, 4096))
    Image.fromarray(np.where((rows + columns) % 2, 0, 254).astype(np.uint8)).save(tmp_path / "map.png")
    sheet = "image: map.png\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\nnegate: 0\n"
    (tmp_path / "map.yaml").write_text(sheet)
    file = tmp_path / "world.yaml"
    file.write_text("properties: {}\nlayers: [{name: solid, map: map.yaml}]\n")
    (walls,) = (layer.walls for layer in load_world(file).layers)
    assert walls is not None
    assert len(walls.segments) > 2 * 4095

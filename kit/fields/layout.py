"""A map's charges: ``charges.yaml`` beside its world file, or derived from its walls where there is none.

intensities: {walls: -1, target: 15, robot: -1, tension: 100}
charges:
  - line: [-0.42, -0.22, 0.42, -0.22]      # x1 y1 x2 y2 [m]
  - point: [0.1, 0.2]
    times: 2                               # twice the walls' intensity
  - composite:
      - line: [0.42, -0.22, 0.42, 1.22]
      - line: [0.42, 1.22, 1.82, 1.22]
      - point: [0.42, 1.22]
    handover: nearest                      # or first_line
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

from numpy.typing import ArrayLike

from kit.arrays import FloatArray
from kit.fields.charge_derivation import derive_charges
from kit.fields.charges import Charge, ChargeField, CompositeCharge, Handover, LineCharge, PointCharge
from kit.fields.occupancy_grid import OccupancyGrid, wall_depth
from kit.world.documents import open_document
from kit.world.yaml_section import Section

LAYOUT_FILE: Final = "charges.yaml"

SAME_CORNER_DISTANCE: Final = 1e-6
"""Ends nearer than this [m] are one corner."""
MAX_WALL_DEPTH: Final = 0.03
"""A charge no farther [m] behind a wall's face lies on it: drawings are not exact."""

HANDOVERS: Final = MappingProxyType({each.value: each for each in Handover})


@dataclass(frozen=True, slots=True)
class Intensities:
    """How strongly each kind of charge acts. The defaults are the dissertation's (tutorial 3)."""

    walls: float = -1.0
    """N m^2, of every charge of the layout, times its own ``times``."""
    target: float = 15.0
    """N m^2, of the point charge at the target."""
    robot: float = -1.0
    """N m^2, of each robot for the other one."""
    tension: float = 100.0
    """N/m, of the point each robot should be at."""


@dataclass(frozen=True, slots=True, eq=False)
class ChargeLayout:
    """Charges of strength 1 and the intensities that scale them: a changed intensity needs no new field."""

    charges: tuple[Charge, ...]
    intensities: Intensities
    source: Path | None
    """The file they were read from; None: derived from the walls."""
    field: ChargeField

    def with_intensities(self, intensities: Intensities) -> ChargeLayout:
        return replace(self, intensities=intensities)

    def wall_forces(self, points: ArrayLike) -> FloatArray:
        """Forces of all charges but the target's, at ``points`` (..., 2), in that shape [N]."""
        return self.intensities.walls * self.field.forces(points)

    def forces(self, points: ArrayLike, target: tuple[float, float]) -> FloatArray:
        """Forces of all charges, the target's too, at ``points`` (..., 2), in that shape [N]."""
        pull = PointCharge(*target, self.intensities.target).force(points)
        return self.wall_forces(points) + pull


def load_layout(world_file: Path, grid: OccupancyGrid) -> ChargeLayout:
    """The layout beside a world file, or the one derived from its walls. Raises WorldError."""
    file = world_file.parent / LAYOUT_FILE
    return read_layout(file, grid) if file.is_file() else derived_layout(grid)


def derived_layout(grid: OccupancyGrid) -> ChargeLayout:
    """Derives charges from the walls around the floor, with the dissertation's intensities."""
    charges = derive_charges(grid)
    return ChargeLayout(charges, Intensities(), None, ChargeField.from_charges(charges))


def read_layout(file: Path, grid: OccupancyGrid | None = None) -> ChargeLayout:
    """Reads a charge file; with ``grid`` also checks that no charge lies inside a wall.

    Raises WorldError with all that is wrong.
    """
    surface = None if grid is None else WallSurface(grid, grid.wall_faces())
    with open_document(file) as section:
        intensities, charges = read_charges(section, surface)
    return ChargeLayout(charges, intensities, file, ChargeField.from_charges(charges))


def read_charges(section: Section, surface: WallSurface | None) -> tuple[Intensities, tuple[Charge, ...]]:
    """Reads what a charge file holds; what is wrong is noted in the section.

    ================================ ============================================================================
    intensities                      how strongly each kind of charge acts
    intensities.walls                of every charge of the list, times its own factor [N m^2]
    intensities.target               of the point charge at the target, which must attract [N m^2]
    intensities.robot                of each robot for the other one [N m^2]
    intensities.tension              of the point where each of two robots should be [N/m]
    charges                          the walls' charges; each is one of line, point and composite
    charges[].times                  factor of the walls' intensity
    charges[].line                   x1, y1, x2, y2 [m]; instead of it, point: [x, y]
    charges[].point                  x, y [m]
    charges[].composite              lines and points that act as one wall with corners
    charges[].handover               which part of a composite acts: the nearest, or the first line of the list
    charges[].composite[].line       x1, y1, x2, y2 [m]
    charges[].composite[].point      x, y [m]
    ================================ ============================================================================
    """
    intensities = _read_intensities(section.section("intensities"))
    return intensities, tuple(_read_charges(section.sections("charges"), surface))


@dataclass(frozen=True, slots=True, eq=False)
class WallSurface:
    """The walls that charges are checked against."""

    grid: OccupancyGrid
    wall_faces: FloatArray


def _read_intensities(section: Section) -> Intensities:
    usual = Intensities()
    read = Intensities(
        walls=section.number("walls", usual.walls),
        target=section.number("target"),
        robot=section.number("robot", usual.robot),
        tension=section.number("tension", usual.tension, minimum=0),
    )
    if read.target <= 0 and section.has("target"):
        section.error("the target must attract: give it an intensity above 0", "target")
    section.finish()
    return read


def _read_charges(sections: Iterable[Section], surface: WallSurface | None) -> Iterator[Charge]:
    for section in sections:
        times = section.number("times", 1.0)
        if section.has("composite"):
            parts = section.sections("composite", at_least=1)
            handover = section.choice("handover", HANDOVERS, Handover.NEAREST.value)
            yield _read_composite(section, parts, times, handover, surface)
        else:
            charge = _read_member(section, times, surface)
            if charge is not None:
                yield charge
        section.finish()


def _read_member(
    section: Section, times: float, surface: WallSurface | None
) -> LineCharge | PointCharge | None:
    if section.has("line"):
        ax, ay, bx, by = section.numbers("line", length=4)
        line = LineCharge(ax, ay, bx, by, times)
        if line.length == 0:
            section.error("the line has no length: its ends are the same point", "line")
        elif surface is not None:
            _check_not_in_wall(section, "line", _points_along(line), surface)
        return line
    if section.has("point"):
        point = PointCharge(*section.point("point"), times)
        if surface is not None:
            _check_not_in_wall(section, "point", [(point.x, point.y)], surface)
        return point
    section.error("a charge must be one of: line, point, composite")
    return None


def _read_composite(
    section: Section,
    parts: tuple[Section, ...],
    times: float,
    handover: Handover,
    surface: WallSurface | None,
) -> CompositeCharge:
    found = []
    for part in parts:
        found.append(_read_member(part, times, surface))
        part.finish()
    lines = tuple(each for each in found if isinstance(each, LineCharge))
    points = tuple(each for each in found if isinstance(each, PointCharge))
    _check_corners(section, lines, points)
    return CompositeCharge(lines, points, handover)


def _check_corners(section: Section, lines: tuple[LineCharge, ...], points: tuple[PointCharge, ...]) -> None:
    """Every line of a composite meets a corner, and where two lines meet there is one: else nothing acts in the
    gap between their strips."""
    corners = [(point.x, point.y) for point in points]
    ends = [end for line in lines for end in line.ends]
    for line in lines:
        if not any(math.dist(end, corner) <= SAME_CORNER_DISTANCE for end in line.ends for corner in corners):
            section.error(
                f"the composite is open: the line {_format_numbers(*line.ends[0], *line.ends[1])} ends at none of its "
                "points. Add the corner as a point, or take the line out",
                "composite",
            )
    for number, end in enumerate(ends):
        meets = any(math.dist(end, other) <= SAME_CORNER_DISTANCE for other in ends[number + 1 :])
        if meets and not any(math.dist(end, corner) <= SAME_CORNER_DISTANCE for corner in corners):
            section.error(
                f"the composite is open: two lines meet at {_format_numbers(*end)}, and there is no point there, so that "
                "nothing acts between their strips",
                "composite",
            )


def _check_not_in_wall(
    section: Section, key: str, places: list[tuple[float, float]], surface: WallSurface
) -> None:
    for x, y in places:
        depth = wall_depth(surface.grid, surface.wall_faces, x, y)
        if depth > MAX_WALL_DEPTH:
            section.error(
                f"the charge is inside a wall: {_format_numbers(x, y)} is {depth:.2f} m behind its surface. "
                "Charges stand on the faces of walls, or in the free space",
                key,
            )
            return


def _points_along(line: LineCharge) -> list[tuple[float, float]]:
    """Places on a line, its ends not quite."""
    return [
        (line.ax + share * (line.bx - line.ax), line.ay + share * (line.by - line.ay))
        for share in (0.02, 0.25, 0.5, 0.75, 0.98)
    ]


def _format_numbers(*numbers: float) -> str:
    return "[" + ", ".join(f"{number:g}" for number in numbers) + "]"

"""A force field as a picture: arrows over the floor, charges, traps, and the forces on each robot."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from kit.arrays import FloatArray
from kit.fields.charges import LineCharge, PointCharge, iter_members
from kit.fields.controller_setup import ControllerSetup
from kit.fields.layout import Intensities
from kit.fields.minima import ForceFlow, Trap
from kit.fields.trajectory import PairControl, control_step
from kit.geometry import Pose
from kit.render.camera import Camera
from kit.render.scene import Scene, SceneMark, ScenePath

ARROW_SPACING: Final = 2
"""Characters from one arrow to the next in a row: as far apart as two rows."""
STRENGTH_SCALE: Final = 2.0
"""A force this many times the median is half as strong as can be shown."""
CHARGE_MARK, TRAP_MARK = "-", "!"
"""Labels of wall charges and traps."""
FORCE_LENGTH: Final = 0.25
"""m: of the line that shows the force on a robot."""


class FieldPicture:
    """The field of one setup, in pictures. Another intensity scales what was computed once."""

    def __init__(self, setup: ControllerSetup) -> None:
        self._setup = setup
        places = setup.grid.cell_centers
        self._walls = setup.layout.field.forces(places)
        self._pull = PointCharge(*setup.target).force(places)
        self._ways: FloatArray | None = None
        self.intensities = setup.layout.intensities

    @property
    def setup(self) -> ControllerSetup:
        """Returns the set-up with the current intensities."""
        return replace(self._setup, layout=self._setup.layout.with_intensities(self.intensities))

    @property
    def forces(self) -> FloatArray:
        """(rows, columns, 2) [N]: at the floor's cells."""
        forces: FloatArray = self.intensities.walls * self._walls + self.intensities.target * self._pull
        return forces

    def traps(self) -> tuple[Trap, ...]:
        """Returns the points other than the target where the forces lead."""
        setup = self._setup
        return ForceFlow.from_forces(self.forces, setup.grid, setup.target, setup.target_radius).traps()

    def directions(self, start: tuple[float, float]) -> FloatArray:
        """(rows, columns, 2): along the planner's ways, unit vectors. Raises Unreachable."""
        if self._ways is None:
            self._ways = self._setup.cost_to_go(start).directions()
        return self._ways

    def arrows(self, vectors: FloatArray, camera: Camera) -> FloatArray:
        """(a, 5): for ``Scene.arrows``, where characters of the camera lie on the floor."""
        grid = self._setup.grid
        columns = np.arange(0, camera.columns, ARROW_SPACING) + 0.5 - camera.columns / 2
        rows = camera.rows / 2 - np.arange(camera.rows) - 0.5
        x, y = np.meshgrid(camera.x + columns * camera.cell_width, camera.y + rows * camera.cell_height)
        column = np.rint((x - grid.origin[0]) / grid.cell_size).astype(int)
        row = np.rint((y - grid.origin[1]) / grid.cell_size).astype(int)
        known = (column >= 0) & (column < grid.shape[1]) & (row >= 0) & (row < grid.shape[0])
        known[known] = grid.inside[row[known], column[known]]
        found = vectors[row[known], column[known]]
        strength = np.hypot(found[:, 0], found[:, 1])
        middling = STRENGTH_SCALE * float(np.median(strength)) if len(strength) else 1.0
        return np.column_stack((x[known], y[known], found, strength / (strength + middling + 1e-12)))

    def marks(self, traps: Sequence[Trap]) -> tuple[SceneMark, ...]:
        """Charges and traps."""
        places = [_charge_position(charge) for charge in iter_members(self._setup.layout.charges)]
        return (
            *(SceneMark(x, y, CHARGE_MARK) for x, y in places),
            *(SceneMark(trap.x, trap.y, TRAP_MARK) for trap in traps),
        )

    def decision(self, poses: Sequence[Pose]) -> PairControl:
        """Returns the potential fields' command for the robots at these poses."""
        return control_step(poses, self._setup.target, self.setup.layout)


def force_lines(decision: PairControl, poses: Sequence[Pose]) -> tuple[ScenePath, ...]:
    """Returns a line from each robot along the force on it, and one from the middle of the pair along its own."""
    starts = [*(pose[:2] for pose in poses), *([decision.middle] if len(poses) > 1 else [])]
    forces = [*decision.forces, *([decision.middle_force] if len(poses) > 1 else [])]
    lines = []
    for (x, y), force in zip(starts, forces, strict=True):
        strength = math.hypot(*force)
        if strength > 0:
            tip = x + FORCE_LENGTH * force[0] / strength, y + FORCE_LENGTH * force[1] / strength
            lines.append(ScenePath(np.array([(x, y), tip])))
    return tuple(lines)


def with_field(
    scene: Scene, picture: FieldPicture, camera: Camera, vectors: FloatArray | None, traps: Sequence[Trap]
) -> Scene:
    """The scene with arrows (``vectors``: at the floor's cells; None: no arrows), charges, traps and forces."""
    known = {body.model: body.pose for body in scene.robots}
    poses = [known[robot.name] for robot in picture.setup.robots if robot.name in known]
    lines = force_lines(picture.decision(poses), poses) if poses else ()
    arrows = np.empty((0, 5)) if vectors is None else picture.arrows(vectors, camera)
    return replace(
        scene, arrows=arrows, marks=(*scene.marks, *picture.marks(traps)), paths=(*scene.paths, *lines)
    )


def scaled_intensity(intensities: Intensities, name: str, times: float) -> Intensities:
    """One intensity multiplied."""
    return replace(intensities, **{name: getattr(intensities, name) * times})


def _charge_position(charge: PointCharge | LineCharge) -> tuple[float, float]:
    if isinstance(charge, PointCharge):
        return charge.x, charge.y
    return (charge.ax + charge.bx) / 2, (charge.ay + charge.by) / 2

"""Where a pose becomes what is drawn: the models of a world as bodies of a scene."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from kit.geometry import Pose
from kit.render.scene import Disc, SceneBody
from kit.run.scenario import BEACON
from kit.sim.state import FootprintOutline


def scene_bodies(
    outlines: Sequence[FootprintOutline], poses: Mapping[str, Pose], robots: Collection[str]
) -> tuple[SceneBody, ...]:
    """One body for each model that has footprints, in the order of ``poses``: its outlines, and its pose in the world.

    ``robots``: the names of those that are driven. The beacon is the target's own body.
    """
    shapes: dict[str, list[FootprintOutline]] = {}
    for outline in outlines:
        shapes.setdefault(outline.model, []).append(outline)
    return tuple(
        SceneBody(
            model,
            pose,
            tuple(np.array(outline.points) for outline in shapes[model] if not outline.radius),
            tuple(Disc(*outline.points[0], outline.radius) for outline in shapes[model] if outline.radius),
            is_robot=model in robots,
            is_target=model == BEACON,
        )
        for model, pose in poses.items()
        if model in shapes
    )

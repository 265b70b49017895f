"""The field of a map, live: arrows over the floor, traps, the force on each robot, intensities to change."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from enum import Enum
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from textual.binding import BindingType

from kit.arrays import FloatArray
from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction, letter
from kit.dialogue.shared_actions import VIEW_IDS
from kit.document.rows import Row, row
from kit.fields import adjacency
from kit.fields.controller_setup import ControllerSetup, mean_position
from kit.fields.minima import Trap
from kit.fields.planner import Unreachable
from kit.geometry import Pose
from kit.render.camera import Camera
from kit.render.field import FieldPicture, scaled_intensity, with_field
from kit.render.scene import Scene
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.play import PlayScreen
from kit.tui.theme import Theme
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.ros.parameters.parameter_client import ParameterTuner
    from kit.run.scenario import Scenario
    from kit.run.session import Session
    from kit.run.view import View

STEP: Final = 1.1
"""One key press multiplies or divides an intensity by this."""
MOST_TRAPS: Final = 3
"""Listed beside the picture."""


SIGNS: Final = (
    ("→ ⇒  · ", "direction of the force, strong, next to nothing"),
    ("-  !", "a charge on a wall; a trap, where forces cancel"),
    ("lines at robots", "the force on each, and on their middle"),
)


class ArrowSource(Enum):
    """What the arrows show."""

    FORCES = "forces"
    DIRECTIONS = "directions"
    NOTHING = "no arrows"


@dataclass(frozen=True, slots=True, eq=False)
class _FieldSetup:
    """What was made for one session's scenario."""

    scenario: Scenario
    picture: FieldPicture
    tuner: ParameterTuner


class FieldsScreen(PlayScreen, inherit_bindings=False):
    """The play screen with a field over the floor. Robots are driven by whatever controller drives them."""

    help_title = "The field"
    help_notes = (SIGNS,)

    screen_actions = ScreenActions(
        "fields",
        (
            "intensity", "scale", "arrows_shown", "controllers", "choose_map", "pause", "restart", "help",
            "back", "quit",
        ),
        (
            "drive_keys", "step", "speed", "nodes", "trainings", "hand_over", "drive_mode", "zoom",
            *VIEW_IDS,
        ),
        own=(
            letter("intensity", "i", "intensity", "select an intensity: walls, target, robot, tension"),
            ScreenAction("scale", "[ ]", "change", "decrease or increase it; the program adapts at once",
                   (("left_square_bracket", "scale(-1)"), ("right_square_bracket", "scale(1)")), "[ ]"),
            letter("arrows_shown", "o", "arrows", "change the arrows: forces, planned directions, none"),
        ),
        drives=True,
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(
        self,
        theme: Theme,
        place: str,
        controller: str,
        *,
        case: str | None = None,
        folder: Path,
        runs: Path,
        seed: int = 0,
        derived: bool = False,
        charges: Path | None = None,
    ) -> None:
        super().__init__(theme, place, controller, case=case, folder=folder, runs=runs, seed=seed)
        if charges is not None:
            self._find = partial(_with_charges, self._find, charges)
        self._derived = derived
        self._opened: _FieldSetup | None = None
        self._traps: tuple[Trap, ...] = ()
        self._names = ("walls", "target", "robot", "tension")
        self._chosen = 0
        self._kinds = cycle(ArrowSource)
        self.shown = next(self._kinds)

    def open_world(self) -> None:
        super().open_world()
        self.host.set_listener(self._update_picture)

    def on_screen_resume(self) -> None:
        self.host.set_listener(self._update_picture)  # the screen of nodes may have listened meanwhile

    def action_intensity(self) -> None:
        self._chosen = (self._chosen + 1) % len(self._names)
        self._show()

    def action_scale(self, steps: int) -> None:
        """Multiplies the chosen intensity by ``STEP**steps``, in the picture and for the controller."""
        opened = self._opened
        if opened is not None:
            picture = opened.picture
            picture.intensities = scaled_intensity(
                picture.intensities, self._names[self._chosen], STEP**steps
            )
            self._traps = picture.traps()
            self.host.post(self._update_picture)
            self._show()

    def action_arrows_shown(self) -> None:
        self.shown = next(self._kinds)
        self._show()

    def action_zoom(self, steps: int) -> None:
        super().action_zoom(steps)
        self._show()

    def action_pan(self, key: str) -> None:
        super().action_pan(key)
        self._show()

    def action_fit(self) -> None:
        super().action_fit()
        self._show()

    # In the world's thread

    def _update_picture(self, session: Session) -> None:
        """Makes the picture of another scenario, and keeps the controller's intensities as they are on the screen."""
        opened = self._opened
        if opened is None or opened.scenario is not session.scenario:
            opened = self._open(session)
        if opened is not None:
            values = asdict(opened.picture.intensities)
            opened.tuner.update({f"intensity.{name}": float(value) for name, value in values.items()})

    def _open(self, session: Session) -> _FieldSetup | None:
        from kit.ros.parameters.parameter_client import ParameterTuner

        scenario = session.scenario
        if scenario.case is None:
            self.host.set_listener(None)
            self._error_arrived(
                f"{scenario.name} has no target, so its field has none either. Press m to choose another map."
            )
            return None
        try:
            setup = ControllerSetup.load(
                scenario.world.file,
                scenario.partners,
                scenario.case.target,
                scenario.case.target_radius,
                derived=self._derived,
                charges=scenario.charges,
            )
        except (WorldError, LookupError, ValueError) as error:
            self.host.set_listener(None)
            self._error_arrived(str(error))
            return None
        picture = FieldPicture(setup)
        self._traps = picture.traps()
        namespace = scenario.driven.namespace if scenario.driven else ""
        self._opened = _FieldSetup(scenario, picture, ParameterTuner(session.graph, "fields", namespace))
        return self._opened

    # In the face's

    def _figures(self, view: View, mode: str | None) -> tuple[str, Sequence[Row]]:
        opened = self._opened
        if opened is None:
            return super()._figures(view, mode)
        return "field", self._panel(opened.picture, self._poses(view.scene, opened.picture))

    def _newest_scene(self) -> Scene:
        scene, opened = super()._newest_scene(), self._opened
        if opened is None:
            return scene
        camera = self.world.camera or Camera.fit(scene.bounds, *self.world.size)
        vectors = self._vectors(opened.picture, self._poses(scene, opened.picture))
        return with_field(scene, opened.picture, camera, vectors, self._traps)

    def _vectors(self, picture: FieldPicture, poses: Sequence[Pose]) -> FloatArray | None:
        if self.shown is ArrowSource.FORCES:
            return picture.forces
        if self.shown is ArrowSource.DIRECTIONS and poses:
            try:
                return picture.directions(mean_position(poses))
            except Unreachable:
                return None
        return None

    def _poses(self, scene: Scene, picture: FieldPicture) -> list[Pose]:
        known = {body.model: body.pose for body in scene.robots}
        return [known[robot.name] for robot in picture.setup.robots if robot.name in known]

    def _panel(self, picture: FieldPicture, poses: Sequence[Pose]) -> list[Row]:
        """Returns at most 20 rows of 22 characters."""
        values = asdict(picture.intensities)
        rows = [row(("intensities", "title"))]
        for number, name in enumerate(self._names):
            chosen = number == self._chosen
            rows.append(
                row((f"{'>' if chosen else ' '}{name:<8}", "bold" if chosen else ""), f"{values[name]:>9.2f}")
            )
        rows += [row(("arrows", "title")), row(f" {self.shown.value}"), row(("traps", "title"))]
        rows += [
            row(f" ! {trap.x:6.2f} {trap.y:6.2f} {trap.share:4.0%}") for trap in self._traps[:MOST_TRAPS]
        ] or [row(" none")]
        if poses:
            rows.append(row(("forces", "title")))
            decision = picture.decision(poses)
            rows += [
                row(f" {robot.name[:8]:<8}", (f"{math.hypot(*force):9.1f}", "bold"))
                for robot, force in zip(picture.setup.robots, decision.forces, strict=True)
            ]
        if len(poses) == 2:
            beside = "yes" if adjacency.is_adjacent_by_poses(poses[0], poses[1]) else "no"
            rows.append(row(("side by side", "title")))
            rows.append(
                row(f" {beside:<8}", (f"{float(adjacency.adjacency_score(poses[0], poses[1])):9.2f}", "bold"))
            )
        if self.view is not None and self.view.metrics.reached_s is not None:
            rows.append(row(("target reached", "good")))
        return rows


def _with_charges(find: Callable[[], Scenario], charges: Path) -> Scenario:
    return replace(find(), charges=charges)

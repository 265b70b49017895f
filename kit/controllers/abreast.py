"""Abreast: two robots side by side along a planned path, comfortable for passengers; or one robot alone.

Knows the map, as the potential fields do, but plans: a way of least cost has no traps. It says before driving
if no way leads to the target.
"""

from collections.abc import Sequence

from kit.controllers.odometry import SetupNode, spin
from kit.fields.controller_setup import ControllerSetup
from kit.fields.planner import Unreachable
from kit.fields.trajectory import TrajectoryTracker, VelocityCommand
from kit.geometry import Pose


class Abreast(SetupNode):
    def __init__(self) -> None:
        super().__init__("abreast")
        self._tracker: TrajectoryTracker | None = None

    def step(self, setup: ControllerSetup, poses: Sequence[Pose]) -> Sequence[VelocityCommand] | None:
        if self._tracker is None:
            try:
                trajectory = setup.plan_trajectory(poses)
            except Unreachable as reason:
                self.stop(f"Not driving. {reason}")
                return None
            self.get_logger().info(f"The drive takes {trajectory.seconds:.1f} s.")
            self._tracker = TrajectoryTracker(trajectory)
        return self._tracker.commands(poses)


def main(args: list[str] | None = None) -> None:
    spin(Abreast, args)


if __name__ == "__main__":
    main()

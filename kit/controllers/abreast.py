"""Abreast: two robots side by side along a planned way, within what passengers bear; or one robot alone.

Knows the map, as the potential fields do, but plans: a way of least cost has no traps. It says before driving
if no way leads to the target.
"""

from collections.abc import Sequence

from kit.controllers.odometry import SetupNode, spin
from kit.fields.controller_setup import ControllerSetup
from kit.fields.pair import VelocityCommand
from kit.fields.planner import Unreachable
from kit.fields.trajectory import TrajectoryTracker
from kit.geometry import Pose


class Abreast(SetupNode):
    def __init__(self) -> None:
        super().__init__("abreast")
        self._follower: TrajectoryTracker | None = None

    def step(self, course: ControllerSetup, poses: Sequence[Pose]) -> Sequence[VelocityCommand] | None:
        if self._follower is None:
            try:
                ride = course.plan_trajectory(poses)
            except Unreachable as reason:
                self.stop(f"Not driving. {reason}")
                return None
            self.get_logger().info(f"A ride of {ride.seconds:.1f} s.")
            self._follower = TrajectoryTracker(ride)
        return self._follower.commands(poses)


def main(args: list[str] | None = None) -> None:
    spin(Abreast, args)


if __name__ == "__main__":
    main()

"""Potential fields: two robots as one system, as in the dissertation (4.1.3, tutorial 3); or one robot alone.

Walls push, the target pulls, and where the forces cancel it stays for ever: it says beforehand whether they will.
The intensities are parameters, to be changed while it drives.
"""

from collections.abc import Sequence
from dataclasses import replace

from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from kit.controllers.odometry import SetupNode, spin
from kit.fields.controller_setup import ControllerSetup, mean_position
from kit.fields.layout import Intensities
from kit.fields.trajectory import VelocityCommand, control_step
from kit.geometry import Pose


class Fields(SetupNode):
    def __init__(self) -> None:
        super().__init__("fields")
        self._is_trap_checked = False
        if self.setup is not None:
            usual = self.setup.layout.intensities
            for name in Intensities.__dataclass_fields__:
                given = self.declare_parameter(f"intensity.{name}", getattr(usual, name)).value
                self._set_intensity(name, float(given))
            self.setup.flow.end(*self.setup.target)  # computed here: a step has less time than the start
        self.add_on_set_parameters_callback(self._on_parameters)

    def step(self, setup: ControllerSetup, poses: Sequence[Pose]) -> Sequence[VelocityCommand]:
        if not self._is_trap_checked:
            self._is_trap_checked = True
            self._warn_of_trap(setup, poses)
        return control_step(poses, setup.target, setup.layout).commands

    def _warn_of_trap(self, setup: ControllerSetup, poses: Sequence[Pose]) -> None:
        start = mean_position(poses)
        end = setup.flow.end(*start)
        if end is not None and not setup.flow.reaches(*start):
            self.get_logger().warning(
                f"The forces lead into a trap at ({end[0]:.2f}, {end[1]:.2f}): there walls push as strongly as "
                "the target pulls."
            )

    def _on_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            kind, _, name = parameter.name.partition(".")
            if kind == "intensity" and name in Intensities.__dataclass_fields__:
                self._set_intensity(name, float(parameter.value))
        return SetParametersResult(successful=True)

    def _set_intensity(self, name: str, intensity: float) -> None:
        if self.setup is not None:
            layout = self.setup.layout
            changed = replace(layout.intensities, **{name: intensity})
            self.setup = replace(self.setup, layout=layout.with_intensities(changed))


def main(args: list[str] | None = None) -> None:
    spin(Fields, args)


if __name__ == "__main__":
    main()

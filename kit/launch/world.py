"""Reads the parameters of ``flatland_server`` in a launch file: the world, its rate and step size."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from kit.launch.processes import ProcessStartError
from kit.launch.requests import StartRequest
from kit.plain_text import nearest_name
from kit.ros.exceptions import InvalidRosArguments
from kit.ros.execution.arguments import parse_ros_arguments

NODE_NAME: Final = "flatland_server"

PARAMETERS: Final = frozenset(
    {
        "world_path",
        "update_rate",
        "step_size",
        "show_viz",
        "viz_pub_rate",
        "use_sim_time",
        "use_rviz",
        "simplify_map",
    }
)
"""The parameters of flatland_server; those of visualization and of the clock have no effect here."""


@dataclass(frozen=True, slots=True)
class WorldRequest:
    """The parameters of ``flatland_server``, with its own defaults."""

    path: Path
    update_rate: float = 200.0
    """Ticks a second of wall clock [Hz]."""
    step_size: float = 0.005
    """Simulated time of a tick [s]."""
    show_viz: bool = False
    where: str = ""
    """File and line of the launch file, for messages."""

    @property
    def factor(self) -> float:
        """Simulated seconds per second of wall clock."""
        return self.update_rate * self.step_size


def parse_world_request(request: StartRequest) -> WorldRequest:
    """Parses the arguments of the request. Raises ProcessStartError."""
    try:
        given = parse_ros_arguments(request.command).parameters_of(NODE_NAME, "/")
    except InvalidRosArguments as problem:
        raise ProcessStartError(f"{request.where}flatland_server: {problem}") from None
    values = {name: parameter.value for name, parameter in given.items()}
    for name in sorted(values.keys() - PARAMETERS):
        near = nearest_name(name, PARAMETERS)
        hint = f"; did you mean '{near}'?" if near else ""
        raise ProcessStartError(f"{request.where}flatland_server has no parameter '{name}'{hint}")
    if "world_path" not in values:
        raise ProcessStartError(
            f"{request.where}flatland_server: the parameter 'world_path' is missing: "
            "parameters=[{'world_path': 'FILE.yaml'}]"
        )
    default = WorldRequest(Path())
    return WorldRequest(
        (request.cwd or Path.cwd()) / str(values["world_path"]),
        _positive_number(request, values, "update_rate", default.update_rate),
        _positive_number(request, values, "step_size", default.step_size),
        _boolean(request, values, "show_viz", default.show_viz),
        request.where,
    )


def _positive_number(request: StartRequest, values: dict[str, Any], name: str, default: float) -> float:
    value = values.get(name, default)
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if isinstance(value, bool) or not (math.isfinite(number) and number > 0):
        raise ProcessStartError(
            f"{request.where}flatland_server: '{name}' must be a number above 0, not {value!r}"
        )
    return number


def _boolean(request: StartRequest, values: dict[str, Any], name: str, default: bool) -> bool:
    value = values.get(name, default)
    if not isinstance(value, bool):
        raise ProcessStartError(
            f"{request.where}flatland_server: '{name}' must be true or false, not {value!r}"
        )
    return value

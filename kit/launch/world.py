"""What a launch file asks of Flatland's server: which world, how fast, in what steps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from kit.launch.errors import CannotStart
from kit.launch.requests import Start
from kit.plain_text import nearest_name
from kit.ros.exceptions import InvalidRosArguments
from kit.ros.execution.arguments import parse_ros_arguments

NODE: Final = "flatland_server"

KNOWN: Final = frozenset(
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
"""Its parameters; those of the picture and of ROS 2's clock make no difference here."""


@dataclass(frozen=True, slots=True)
class WorldWanted:
    """The parameters of ``flatland_server``, with its own defaults."""

    path: Path
    update_rate: float = 200.0
    """Ticks a second of wall clock [Hz]."""
    step_size: float = 0.005
    """Simulated time of a tick [s]."""
    show_viz: bool = False
    where: str = ""
    """Where it was asked for."""

    @property
    def factor(self) -> float:
        """Simulated seconds per second."""
        return self.update_rate * self.step_size


def world_wanted(request: Start) -> WorldWanted:
    """What the request's arguments say. Raises CannotStart."""
    try:
        given = parse_ros_arguments(request.command).parameters_of(NODE, "/")
    except InvalidRosArguments as problem:
        raise CannotStart(f"{request.where}flatland_server: {problem}") from None
    values = {name: parameter.value for name, parameter in given.items()}
    for name in sorted(values.keys() - KNOWN):
        near = nearest_name(name, KNOWN)
        hint = f"; did you mean '{near}'?" if near else ""
        raise CannotStart(f"{request.where}flatland_server has no parameter '{name}'{hint}")
    if "world_path" not in values:
        raise CannotStart(
            f"{request.where}flatland_server: the parameter 'world_path' is missing: "
            "parameters=[{'world_path': 'FILE.yaml'}]"
        )
    usual = WorldWanted(Path())
    return WorldWanted(
        (request.cwd or Path.cwd()) / str(values["world_path"]),
        _above_zero(request, values, "update_rate", usual.update_rate),
        _above_zero(request, values, "step_size", usual.step_size),
        _truth(request, values, "show_viz", usual.show_viz),
        request.where,
    )


def _above_zero(request: Start, values: dict[str, Any], name: str, usual: float) -> float:
    value = values.get(name, usual)
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if isinstance(value, bool) or not (math.isfinite(number) and number > 0):
        raise CannotStart(f"{request.where}flatland_server: '{name}' must be a number above 0, not {value!r}")
    return number


def _truth(request: Start, values: dict[str, Any], name: str, usual: bool) -> bool:
    value = values.get(name, usual)
    if not isinstance(value, bool):
        raise CannotStart(f"{request.where}flatland_server: '{name}' must be true or false, not {value!r}")
    return value

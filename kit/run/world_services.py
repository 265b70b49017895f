"""Offers the world's services in the graph: Flatland's own, and reset, step and state, which it lacks."""

from __future__ import annotations

import math
from collections.abc import Awaitable
from typing import Any, Final, Protocol

from kit.msg import builtin_interfaces, flatland_msgs, geometry_msgs, robot_kit_msgs, std_srvs
from kit.ros.node.node import Node
from kit.sim.simulation import Simulation, SimulationError

GET_STATE_SERVICE: Final = "/get_state"
"""Answers with the true state of the whole world."""


class ControllableRun(Protocol):
    """The part of a runner that the services use."""

    simulation: Simulation
    paused: bool

    def call_service(self, service: str, *arguments: Any) -> None:
        """Calls one of ``kit.sim.simulation.SERVICES``. Raises SimulationError."""

    def offers_truth(self, name: str) -> bool:
        """True if nodes may use this ground-truth topic or service; ``name``: absolute."""

    def step_paused(self, ticks: int) -> Awaitable[None]:
        """Makes ``ticks`` ticks although the run is paused."""

    def set_rate(self, rate: float) -> bool:
        """Asks for ``rate`` ticks per second of wall clock; false where nobody paces this run."""


class WorldServices:
    """Creates the services on ``node``, the world's own, and answers them."""

    def __init__(self, node: Node, run: ControllableRun) -> None:
        self._run = run
        for name, service_type, callback in (
            ("/spawn_model", flatland_msgs.SpawnModel, self._spawn),
            ("/delete_model", flatland_msgs.DeleteModel, self._delete),
            ("/move_model", flatland_msgs.MoveModel, self._move),
            ("/pause", std_srvs.Empty, self._pause),
            ("/resume", std_srvs.Empty, self._resume),
            ("/toggle_pause", std_srvs.Empty, self._toggle),
            ("/change_rate", flatland_msgs.ChangeRate, self._rate),
            ("/reset", robot_kit_msgs.Reset, self._reset),
            ("/step", robot_kit_msgs.Step, self._step),
            (GET_STATE_SERVICE, robot_kit_msgs.GetState, self._state),
        ):
            if name != GET_STATE_SERVICE or run.offers_truth(name):
                node.create_service(service_type, name, callback)

    def _call(self, response: ServiceOutcome, service: str, *arguments: Any) -> None:
        try:
            self._run.call_service(service, *arguments)
        except SimulationError as error:
            response.success, response.message = False, str(error)
        else:
            response.success = True

    def _spawn(
        self, request: flatland_msgs.SpawnModel.Request, response: flatland_msgs.SpawnModel.Response
    ) -> flatland_msgs.SpawnModel.Response:
        file = self._run.simulation.world.file.parent / request.yaml_path
        self._call(response, "spawn_model", str(file), request.name, request.ns, _pose(request.pose))
        return response

    def _delete(
        self, request: flatland_msgs.DeleteModel.Request, response: flatland_msgs.DeleteModel.Response
    ) -> flatland_msgs.DeleteModel.Response:
        self._call(response, "delete_model", request.name)
        return response

    def _move(
        self, request: flatland_msgs.MoveModel.Request, response: flatland_msgs.MoveModel.Response
    ) -> flatland_msgs.MoveModel.Response:
        self._call(response, "move_model", request.name, _pose(request.pose))
        return response

    def _pause(
        self, request: std_srvs.Empty.Request, response: std_srvs.Empty.Response
    ) -> std_srvs.Empty.Response:
        self._run.paused = True
        return response

    def _resume(
        self, request: std_srvs.Empty.Request, response: std_srvs.Empty.Response
    ) -> std_srvs.Empty.Response:
        self._run.paused = False
        return response

    def _toggle(
        self, request: std_srvs.Empty.Request, response: std_srvs.Empty.Response
    ) -> std_srvs.Empty.Response:
        self._run.paused = not self._run.paused
        return response

    def _rate(
        self, request: flatland_msgs.ChangeRate.Request, response: flatland_msgs.ChangeRate.Response
    ) -> flatland_msgs.ChangeRate.Response:
        if not (math.isfinite(request.rate) and request.rate > 0):
            response.message = f"The rate is in ticks per second and must be above 0, not {request.rate}."
        elif not self._run.set_rate(request.rate):
            response.message = "This run has no wall clock: it goes as fast as it is stepped."
        else:
            response.success = True
        return response

    def _reset(
        self, request: robot_kit_msgs.Reset.Request, response: robot_kit_msgs.Reset.Response
    ) -> robot_kit_msgs.Reset.Response:
        seed = request.seed if request.new_seed else None
        self._call(response, "reset", seed)
        return response

    async def _step(
        self, request: robot_kit_msgs.Step.Request, response: robot_kit_msgs.Step.Response
    ) -> robot_kit_msgs.Step.Response:
        if self._run.paused:
            await self._run.step_paused(request.ticks)
            response.success = True
        else:
            response.message = "The world is running: call /pause before /step."
        response.stamp = _stamp(self._run.simulation.time_ns)
        return response

    def _state(
        self, request: robot_kit_msgs.GetState.Request, response: robot_kit_msgs.GetState.Response
    ) -> robot_kit_msgs.GetState.Response:
        state = self._run.simulation.state()
        response.stamp = _stamp(state.time_ns)
        response.tick = state.tick
        response.paused = self._run.paused
        for body in state.bodies:
            vx, vy, omega = body.velocity
            response.bodies.append(
                robot_kit_msgs.BodyState(
                    model=body.model,
                    body=body.body,
                    pose=geometry_msgs.Pose2D(x=body.pose.x, y=body.pose.y, theta=body.pose.theta),
                    twist=geometry_msgs.Twist(
                        linear=geometry_msgs.Vector3(x=vx, y=vy), angular=geometry_msgs.Vector3(z=omega)
                    ),
                )
            )
        return response


class ServiceOutcome(Protocol):
    """A response with fields for success and an error message."""

    success: bool
    message: str


def _pose(pose: geometry_msgs.Pose2D) -> tuple[float, float, float]:
    return pose.x, pose.y, pose.theta


def _stamp(time_ns: int) -> builtin_interfaces.Time:
    return builtin_interfaces.Time(sec=time_ns // 1_000_000_000, nanosec=time_ns % 1_000_000_000)

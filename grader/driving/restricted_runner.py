"""A world whose services are restricted by the assignment, and whose clock no program can pause."""

from __future__ import annotations

from typing import Any, Final

from kit.geometry import Pose
from kit.msg.robot_kit_msgs import GetState
from kit.ros.graph.graph import Graph
from kit.run.runner import GET_STATE_SERVICE, Runner
from kit.sim.simulation import Simulation, SimulationError

GET_STATE: Final = GET_STATE_SERVICE.removeprefix("/")
"""The service that tells the true state of the world, as an assignment names it."""

HOME_TOLERANCE: Final = 1e-6
"""A robot may be moved to within this distance of its home [m, rad], and nowhere else."""


class RestrictedRunner(Runner):
    """A runner whose world services are restricted by the assignment, and whose clock no program can pause.

    The true state of the world is not offered, unless the assignment names its topic or its service.
    """

    def __init__(
        self,
        simulation: Simulation,
        graph: Graph,
        services: frozenset[str],
        topics: frozenset[str] = frozenset(),
    ) -> None:
        self._services = services
        self._home: tuple[str | None, Pose] = (None, Pose())
        self.refused: list[str] = []
        super().__init__(simulation, graph, offered_truths=topics | (services & {GET_STATE}))

    def count_hidden_clients(self) -> None:
        """Counts clients of the service for the true state of the world, which is not offered, as refused."""
        if not self.offers_truth(GET_STATE_SERVICE):
            self.refused += [
                GET_STATE
                for node in self.graph.directory.nodes
                for client in node.clients
                if client.service_name == GET_STATE_SERVICE and client.srv_type is GetState
            ]

    def allow_home(self, robot: str | None, home: Pose) -> None:
        """Sets the robot and the home it may be moved to."""
        self._home = robot, home

    def call_service(self, service: str, *arguments: Any) -> None:
        if not self._is_allowed(service, arguments):
            self.refused.append(service)
            raise SimulationError(f"{service} is not allowed while a program is graded")
        super().call_service(service, *arguments)

    def call_unrestricted(self, service: str, *arguments: Any) -> None:
        """Calls a service without the restrictions, for the grader itself."""
        super().call_service(service, *arguments)

    @property
    def paused(self) -> bool:
        return False

    @paused.setter
    def paused(self, value: bool) -> None:
        if value:
            self.refused.append("pause")

    def _is_allowed(self, service: str, arguments: tuple[Any, ...]) -> bool:
        if service not in self._services:
            return False
        if service != "move_model":
            return True
        robot, home = self._home
        name, pose = arguments
        return name == robot and all(
            abs(wanted - allowed) <= HOME_TOLERANCE for wanted, allowed in zip(pose, home, strict=True)
        )

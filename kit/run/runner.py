"""The tick: runs nodes, devices and physics in turn. Everything that runs a world calls this.

The conversation (``kit.ros``) and the world (``kit.sim``) do not know each other; they meet here. Wall-clock
pacing is the caller's business: same world + same seed + same inputs = the same run, to the bit.

Offers the world's services in the graph: Flatland's own, and reset, step and state, which it lacks.
"""

from __future__ import annotations

import math
from collections.abc import Awaitable, Callable, Iterable
from functools import partial
from typing import Any, Final, Protocol

from kit.msg import builtin_interfaces, flatland_msgs, geometry_msgs, robot_kit_msgs, std_srvs
from kit.ros.execution.task import Future
from kit.ros.graph.directory import WORLD_NODE_NAME
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.run.command_limits import CommandLimits
from kit.run.lockstep import Observer, Participant, exchange_until_idle
from kit.sim.plugin import OutgoingMessage, TopicEndpoint
from kit.sim.simulation import Simulation, SimulationError, call_service

HIDDEN_NAMESPACE: Final = "/_world"
"""Where the services of a hidden world are: the commands for nodes and services leave names out that begin with ``_``."""
GET_STATE_SERVICE: Final = "/get_state"
"""Answers with the true state of the whole world."""


class Runner:
    """One world and one graph in lock-step. ``participants`` and ``observers`` may come and go between ticks.

    While ``paused`` the clock, the devices and the physics stand still; nodes still answer services.
    ``on_rate`` is called when a node asks for another rate [ticks/s of wall clock]; None refuses.
    """

    def __init__(
        self,
        simulation: Simulation,
        graph: Graph,
        *,
        offered_truths: frozenset[str] | None = None,
        is_hidden: bool = False,
    ) -> None:
        """``is_hidden``: the world's own node and services have hidden names, for a world that only draws what other nodes do.

        ``offered_truths``: the ground-truth topics and the service ``get_state``, by name, that nodes may use; a
        relative name stands for that of every robot. None: all.
        """
        self.simulation = simulation
        self.graph = graph
        self.participants: list[Participant] = []
        self.observers: list[Observer] = []
        self.paused = False
        self.on_rate: Callable[[float], None] | None = None
        self._offered_truths = offered_truths
        self._paused_steps: list[
            tuple[int, Future[None]]
        ] = []  # ticks still to make, and the future of the last
        self._node = create_graph_node(graph, f"_{WORLD_NODE_NAME}" if is_hidden else WORLD_NODE_NAME)
        graph.reserved_names.add(self._node.handle.full_name)
        self._endpoints: dict[TopicEndpoint, Callable[[], object]] = {}  # what destroys each again
        self._publishers: dict[str, Callable[[Any], None]] = {}
        self._limits = CommandLimits(graph)
        WorldServices(self._node, self, HIDDEN_NAMESPACE if is_hidden else "")
        self._connect_devices()
        for remark in simulation.world.remarks:
            graph.log.warning(WORLD_NODE_NAME, str(remark))

    @property
    def node(self) -> Node:
        """The node of the world itself: its publishers are the devices'."""
        return self._node

    @property
    def step_size(self) -> float:
        """Simulated seconds per tick."""
        return self.simulation.step_size

    def tick(self) -> None:
        """One tick: the nodes' timers and callbacks due now, then devices, physics, devices, observers."""
        exchange_until_idle(self.graph, self.participants)
        is_extra, simulation = self.paused, self.simulation
        if is_extra and not self._paused_steps:
            return
        if sent := simulation.before_step():
            self._publish_all(sent)
        simulation.advance()
        if sent := simulation.after_step():
            self._publish_all(sent)
        self.graph.advance(simulation.time_ns)
        for observer in self.observers:
            observer.on_step(simulation)
        if is_extra:
            self._count_paused_step()

    def exchange_until_idle(self) -> None:
        """Runs callbacks and exchanges messages until nothing is due; time stands still."""
        exchange_until_idle(self.graph, self.participants)

    def call_service(self, service: str, *arguments: Any) -> None:
        """Calls one of ``kit.sim.simulation.SERVICES``; a reset also discards all messages on their way.

        Raises SimulationError.
        """
        call_service(self.simulation, service, *arguments)
        for observer in self.observers:
            observer.on_service(service, *arguments)
        if service == "reset":
            self.graph.discard_messages()
        self._connect_devices()

    def pause(self) -> None:
        """Stops the clock after the present tick."""
        self.paused = True

    def step_paused(self, ticks: int) -> Future[None]:
        """Makes ``ticks`` ticks although the run is paused; the future is done when they are."""
        done: Future[None] = Future()
        if ticks > 0:
            self._paused_steps.append((ticks, done))
        else:
            done.set_result(None)
        return done

    @property
    def paused_steps_left(self) -> int:
        """Ticks of ``step_paused`` that are still to be made."""
        return sum(ticks for ticks, _ in self._paused_steps)

    def set_rate(self, rate: float) -> bool:
        """Asks for ``rate`` ticks per second of wall clock; false where nobody paces this run."""
        if self.on_rate is None:
            return False
        self.on_rate(rate)
        return True

    def offers_truth(self, name: str) -> bool:
        """True if nodes may use this ground-truth topic or service; ``name``: absolute."""
        return self._offered_truths is None or any(
            is_truth_named(name, each) for each in self._offered_truths
        )

    def _connect_devices(self) -> None:
        """Gives the graph the world's present topics and time: after a spawn, a delete, a reset."""
        endpoints = [
            endpoint
            for endpoint in self.simulation.endpoints
            if not endpoint.is_ground_truth or self.offers_truth(endpoint.topic)
        ]
        for endpoint in [gone for gone in self._endpoints if gone not in endpoints]:
            self._disconnect(endpoint)
        for endpoint in endpoints:
            if endpoint not in self._endpoints:
                self._connect(endpoint)
        self.graph.advance(self.simulation.time_ns)

    def _connect(self, endpoint: TopicEndpoint) -> None:
        if endpoint.direction == "publish":
            publisher = self._node.create_publisher(endpoint.type, endpoint.topic, 10)
            self._publishers[endpoint.topic] = publisher.publish_without_copy
            self._endpoints[endpoint] = partial(self._node.destroy_publisher, publisher)
        else:
            accept = partial(self.accept, endpoint.topic)
            subscription = self._node.create_subscription(endpoint.type, endpoint.topic, accept, 10)
            self._endpoints[endpoint] = partial(self._node.destroy_subscription, subscription)
            self._limits.add(endpoint)
            if endpoint.type is geometry_msgs.Twist:
                topic = self.graph.directory.topics[subscription.topic_name]
                topic.on_other_type = partial(self._accept_stamped, endpoint)

    def _accept_stamped(self, endpoint: TopicEndpoint, given: type[Any]) -> None:
        """Subscribes to commands with a stamp too, once they are published: today's bases take them in that form."""
        if given is not geometry_msgs.TwistStamped:
            return
        destroy_first = self._endpoints[endpoint]
        stamped = self._node.create_subscription(
            geometry_msgs.TwistStamped,
            endpoint.topic,
            lambda message: self.accept(endpoint.topic, message.twist),
            10,
        )

        def destroy_both() -> None:
            destroy_first()
            self._node.destroy_subscription(stamped)

        self._endpoints[endpoint] = destroy_both

    def _disconnect(self, endpoint: TopicEndpoint) -> None:
        self._endpoints.pop(endpoint)()
        self._limits.discard(endpoint)

    def accept(self, topic: str, message: Any) -> None:
        """Hands a message to the devices that subscribe to the topic."""
        for observer in self.observers:
            observer.on_message(topic, message)
        self.simulation.accept(topic, message)

    def _publish_all(self, messages: Iterable[OutgoingMessage]) -> None:
        for topic, message in messages:
            publish = self._publishers.get(topic)
            if publish is not None:  # ground truth that is not offered
                publish(message)

    def _count_paused_step(self) -> None:
        ticks, done = self._paused_steps.pop(0)
        if ticks > 1:
            self._paused_steps.insert(0, (ticks - 1, done))
        else:
            done.set_result(None)


def is_truth_named(name: str, given: str) -> bool:
    """True if a truth's absolute ``name`` is the ``given`` one: equal, or of any robot where ``given`` has no slash in front."""
    return name == given or name.endswith(f"/{given}")


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

    def __init__(self, node: Node, run: ControllableRun, namespace: str = "") -> None:
        """``namespace``: what is put before the names of the services."""
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
                node.create_service(service_type, f"{namespace}{name}", callback)

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
            response.message = "This run has no wall clock: it runs as fast as it is stepped."
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

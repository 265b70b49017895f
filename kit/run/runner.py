"""The tick: runs nodes, devices and physics in turn. Everything that runs a world calls this.

The conversation (``kit.ros``) and the world (``kit.sim``) do not know each other; they meet here. Wall-clock
pacing is the caller's business: same world + same seed + same inputs = the same run, to the bit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.run.lockstep import Observer, Participant, exchange_until_idle
from kit.run.world_services import WorldServices
from kit.sim.plugin import OutgoingMessage, TopicEndpoint
from kit.sim.simulation import Simulation, call_service


def is_truth_named(name: str, given: str) -> bool:
    """True if a truth's absolute ``name`` is the ``given`` one: equal, or of any robot where ``given`` has no slash in front."""
    return name == given or name.endswith(f"/{given}")


class Runner:
    """One world and one graph in lock-step. ``participants`` and ``observers`` may come and go between ticks.

    While ``paused`` the clock, the devices and the physics stand still; nodes still answer services.
    ``on_rate`` is called when a node asks for another rate [ticks/s of wall clock]; None refuses.
    """

    def __init__(
        self, simulation: Simulation, graph: Graph, *, offered_truths: frozenset[str] | None = None
    ) -> None:
        """``offered_truths``: the ground-truth topics and the service ``get_state``, by name, that nodes may use; a
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
        self._node = create_graph_node(graph, "flatland_server")
        graph.reserved_names.add(self._node.handle.full_name)
        self._endpoints: dict[TopicEndpoint, Callable[[], object]] = {}  # what destroys each again
        self._publishers: dict[str, Callable[[Any], None]] = {}
        WorldServices(self._node, self)
        self._connect_devices()

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
        self.exchange_until_idle()
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
        """Calls one of ``kit.sim.services.SERVICES``; a reset also discards all messages on their way.

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

    def _disconnect(self, endpoint: TopicEndpoint) -> None:
        self._endpoints.pop(endpoint)()

    def accept(self, topic: str, message: Any) -> None:
        """Hands a message to the devices that subscribe to the topic."""
        for observer in self.observers:
            observer.on_message(topic, message)
        self.simulation.accept(topic, message)

    def _publish_all(self, messages: Iterable[OutgoingMessage]) -> None:
        for outgoing in messages:
            publish = self._publishers.get(outgoing.topic)
            if publish is not None:  # ground truth that is not offered
                publish(outgoing.message)

    def _count_paused_step(self) -> None:
        ticks, done = self._paused_steps.pop(0)
        if ticks > 1:
            self._paused_steps.insert(0, (ticks - 1, done))
        else:
            done.set_result(None)

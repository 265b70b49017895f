"""The tick: how nodes, devices and physics take turns. Everything that runs a world calls this.

The conversation (``kit.ros``) and the world (``kit.sim``) do not know each other; they meet here. Wall-clock
pacing is the caller's business: same world + same seed + same inputs = the same run, to the bit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, Protocol

from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.run.lockstep import Guest, converse
from kit.run.world_services import offer_world_services
from kit.sim.plugin import Endpoint, Outgoing
from kit.sim.services import tell
from kit.sim.simulation import Simulation


class Observer(Protocol):
    """Who wants to know of every tick and of everything that reached the world from outside."""

    def accepted(self, topic: str, message: Any) -> None: ...

    def called(self, service: str, *arguments: Any) -> None: ...

    def ticked(self, simulation: Simulation) -> None: ...


class Runner:
    """One world and one graph in lock-step. ``guests`` and ``observers`` may come and go between ticks.

    While ``paused`` the clock, the devices and the physics stand still; nodes still answer services.
    ``on_rate`` is told when a node asks for another rate [ticks/s of wall clock]; None refuses.
    """

    def __init__(self, simulation: Simulation, graph: Graph) -> None:
        self.simulation = simulation
        self.graph = graph
        self.guests: list[Guest] = []
        self.observers: list[Observer] = []
        self.paused = False
        self.on_rate: Callable[[float], None] | None = None
        self._allowed: list[
            tuple[int, Future[None]]
        ] = []  # ticks in spite of the pause, and who waits for them
        self._node = graph.create_node("flatland_server")
        self._wires: dict[Endpoint, Callable[[], object]] = {}  # how to take each down again
        self._publish: dict[str, Callable[[Any], None]] = {}
        offer_world_services(self._node, self)
        self._wire_devices()

    def tick(self) -> None:
        """One tick: the nodes' timers and callbacks due now, then devices, physics, devices, observers."""
        self.converse()
        is_extra = self.paused
        if is_extra and not self._allowed:
            return
        self._carry(self.simulation.before_step())
        self.simulation.advance()
        self._carry(self.simulation.after_step())
        self.graph.advance(self.simulation.time_ns)
        for observer in self.observers:
            observer.ticked(self.simulation)
        if is_extra:
            self._count_down()

    def converse(self) -> None:
        """Lets nodes and guests talk until all is said."""
        converse(self.graph, self.guests)

    def tell(self, service: str, *arguments: Any) -> None:
        """One of ``kit.sim.services.SERVICES``. After a reset nothing of before is on its way any more.

        Raises SimulationError.
        """
        tell(self.simulation, service, *arguments)
        for observer in self.observers:
            observer.called(service, *arguments)
        if service == "reset":
            self.graph.discard()
        self._wire_devices()

    def pause(self) -> None:
        """The clock stands still from here on."""
        self.paused = True

    def allow(self, ticks: int) -> Future[None]:
        """So many ticks in spite of the pause. The future is done when they are."""
        done: Future[None] = Future()
        if ticks > 0:
            self._allowed.append((ticks, done))
        else:
            done.set_result(None)
        return done

    @property
    def steps_left(self) -> int:
        """Ticks allowed in spite of the pause and not yet done."""
        return sum(ticks for ticks, _ in self._allowed)

    def set_rate(self, rate: float) -> bool:
        if self.on_rate is None:
            return False
        self.on_rate(rate)
        return True

    def _wire_devices(self) -> None:
        """Sees to it that the graph has the world's present topics and time: after a spawn, a delete, a reset."""
        endpoints = self.simulation.endpoints
        for endpoint in [gone for gone in self._wires if gone not in endpoints]:
            self._unwire(endpoint)
        for endpoint in endpoints:
            if endpoint not in self._wires:
                self._wire(endpoint)
        self.graph.advance(self.simulation.time_ns)

    def _wire(self, endpoint: Endpoint) -> None:
        if endpoint.direction == "publish":
            publisher = self._node.create_publisher(endpoint.type, endpoint.topic, 10)
            self._publish[endpoint.topic] = publisher.hand_over
            self._wires[endpoint] = partial(self._node.destroy_publisher, publisher)
        else:
            accept = partial(self.accept, endpoint.topic)
            subscription = self._node.create_subscription(endpoint.type, endpoint.topic, accept, 10)
            self._wires[endpoint] = partial(self._node.destroy_subscription, subscription)

    def _unwire(self, endpoint: Endpoint) -> None:
        self._wires.pop(endpoint)()

    def accept(self, topic: str, message: Any) -> None:
        """Hands a message to the devices that subscribe to the topic."""
        for observer in self.observers:
            observer.accepted(topic, message)
        self.simulation.accept(topic, message)

    def _carry(self, messages: Iterable[Outgoing]) -> None:
        for outgoing in messages:
            self._publish[outgoing.topic](outgoing.message)

    def _count_down(self) -> None:
        ticks, done = self._allowed.pop(0)
        if ticks > 1:
            self._allowed.insert(0, (ticks - 1, done))
        else:
            done.set_result(None)

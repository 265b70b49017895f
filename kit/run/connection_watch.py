"""Tells why a program hears nothing, or nobody hears it, or not all of it is done, while a world runs: what some nodes connect
to that has no other end, and what they ask for that is more than the robot can."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Set
from typing import TYPE_CHECKING, Final

from kit.ros.graph.connections import find_excesses, find_mistakes
from kit.ros.graph.graph import Graph
from kit.run.lockstep import Observer

if TYPE_CHECKING:  # a launch without a world must not load the physics
    from kit.sim.simulation import Simulation

MAX_TOLD: Final = 20
"""Sentences that a watch tells of one run."""
STANDS_NS: Final = 2_000_000_000
"""How long a connection is without another end before that is told [ns of simulated time]."""
LOOK_INTERVAL_NS: Final = 500_000_000
SENT_NOTHING: Final = "The program sends no speed."
SENDS: Final = "A Twist on cmd_vel with linear.x or angular.z other than 0 moves the robot."


class ConnectionWatch(Observer):
    """Tells about each connection without another end, once, when it has stood for a while, and of each excess, once.

    Nodes start one after the other: what has found its other end by then is not told.
    """

    def __init__(
        self,
        graph: Graph,
        names: Callable[[], Set[str]],
        tell: Callable[[str], object],
        *,
        commanders: Callable[[], Set[str]] | None = None,
        commands: Callable[[], Collection[str]] = tuple,
        way_out: str = "",
    ) -> None:
        """``names``: the full names of the nodes that are watched now; ``tell`` receives a sentence.

        ``commanders``: those of whose commands too large ones are told, by default the same. ``commands``: topics of which one
        is to get a message while nodes are watched, by default none; ``way_out`` is told with it.
        """
        self._graph, self._names, self._tell = graph, names, tell
        self._commanders = names if commanders is None else commanders
        self._commands = commands
        self._sent_nothing = " ".join(filter(None, (SENT_NOTHING, way_out, SENDS)))  # the end may be cut
        self._is_commanded = False
        self._since_ns: dict[str, int] = {}
        self._told: set[str] = set()
        self._looked_ns = graph.now_ns

    def begin_again(self) -> None:
        """Another version of the program drives, and may send nothing."""
        self._is_commanded = False
        self._since_ns.pop(self._sent_nothing, None)
        self._told.discard(self._sent_nothing)

    def on_message(self, topic: str, message: object) -> None:
        self._is_commanded = self._is_commanded or (topic in self._commands() and message != type(message)())

    def on_step(self, simulation: Simulation) -> None:
        self.look()

    def look(self) -> None:
        """Looks a few times per simulated second, however often it is called."""
        now = self._graph.now_ns
        if 0 <= now - self._looked_ns < LOOK_INTERVAL_NS:
            return
        self._looked_ns = now
        mistakes = self._mistakes()
        self._since_ns = {each: min(now, self._since_ns.get(each, now)) for each in mistakes}
        self._tell_each(each for each, since in self._since_ns.items() if now - since >= STANDS_NS)
        self._tell_each(find_excesses(self._graph, self._commanders()))

    def tell_all(self) -> None:
        """Tells also what has stood for a shorter time: at the end of a run."""
        self._tell_each(self._mistakes())
        self._tell_each(find_excesses(self._graph, self._commanders()))

    def _mistakes(self) -> list[str]:
        """Those of connections; where there are none, which would be why, that nothing was sent."""
        is_silent = not self._is_commanded and self._commands() and self._names()
        return list(find_mistakes(self._graph, self._names())) or ([self._sent_nothing] if is_silent else [])

    def _tell_each(self, mistakes: Iterable[str]) -> None:
        for mistake in mistakes:
            if mistake not in self._told and len(self._told) < MAX_TOLD:
                self._told.add(mistake)
                self._tell(mistake)

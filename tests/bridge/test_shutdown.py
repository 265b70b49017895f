"""The end of a bridge's process: certain, whatever hangs, and after the robots were told to stop."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from kit.bridge.bridge import Bridge, BridgeSettings
from kit.bridge.shutdown import EXIT_HUNG, EXIT_INTERRUPTED, ShutdownDeadline
from kit.bridge.wire import DryRunWire, InterfaceId, SendBytes
from kit.msg.geometry_msgs import Twist
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import QoSProfile
from tests.bridge.sides import routes
from tests.waiting import wait_until

LONG_S = 600.0
"""No test waits so long: what ends with such a limit does not end by it."""


class Exits:
    """Deadlines of this process that only note how they would have ended it."""

    def __init__(self) -> None:
        self.codes: list[int] = []
        self.lines: list[str] = []
        self.stops: list[str] = []
        self._opened: list[ShutdownDeadline] = []

    def open(self, limit_s: float) -> ShutdownDeadline:
        deadline = ShutdownDeadline(self.lines.append, limit_s=limit_s, exit_process=self.codes.append)
        deadline.__enter__()
        self._opened.append(deadline)
        deadline.at_begin(lambda: self.stops.append(threading.current_thread().name))
        return deadline

    def cancel(self) -> None:
        for each in self._opened:
            each.cancel()


@pytest.fixture
def exits() -> Iterator[Exits]:
    made = Exits()
    yield made
    made.cancel()


def test_the_first_interrupt_stops_the_robots_and_the_second_ends_at_once(exits: Exits) -> None:
    exits.open(LONG_S)
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGTERM)
    wait_until(lambda: exits.stops, "the stop")
    assert not exits.codes
    signal.raise_signal(signal.SIGINT)  # raises nothing: it must not disturb the end
    wait_until(lambda: exits.codes, "the exit")
    assert exits.codes == [EXIT_INTERRUPTED]
    assert len(exits.stops) == 1


def test_what_hangs_is_named_at_the_deadline(exits: Exits) -> None:
    restored: list[bool] = []
    deadline = exits.open(0.05)
    deadline.before_exit(lambda: restored.append(True))
    deadline.begin()
    deadline.begin()
    wait_until(lambda: exits.codes, "the exit")
    assert exits.codes == [EXIT_HUNG]
    assert "told to stop" in exits.lines[0]
    assert "wait_until" in exits.lines[0]  # where the main thread is
    assert restored


def test_a_stop_that_hangs_too_is_said_and_holds_nothing_up(exits: Exits) -> None:
    never = threading.Event()
    deadline = exits.open(0.05)
    deadline.at_begin(never.wait)
    deadline.__exit__(None, None, None)  # the end of a `with` statement begins the end, too
    wait_until(lambda: exits.codes, "the exit")
    assert "emergency stops" in exits.lines[0]
    never.set()


def test_before_the_end_has_begun_nothing_is_limited(exits: Exits) -> None:
    exits.open(0.0)
    idle = ShutdownDeadline(exits.lines.append, limit_s=0.0, exit_process=exits.codes.append)
    exits.cancel()
    exits._opened.clear()
    assert not exits.codes
    assert not exits.stops
    with idle:
        assert not exits.codes
    wait_until(lambda: exits.codes, "the exit")
    idle.cancel()


class RefusingWire(DryRunWire):
    """A wire that takes no message any more."""

    def __init__(self) -> None:
        self.refused: list[str] = []
        self.is_closed = False

    def open_publisher(self, name: str, interface: InterfaceId, qos: QoSProfile) -> SendBytes:
        def send(data: bytes) -> None:
            self.refused.append(name)
            raise ConnectionError("the session is closed")

        return send

    def close(self) -> None:
        self.is_closed = True


def test_a_wire_that_refuses_the_stop_is_closed_all_the_same() -> None:
    graph = Graph(None, log_sink=lambda record: None)
    wire, lines = RefusingWire(), list[str]()
    commander = create_graph_node(graph, "pilot")
    for name in ("/left", "/right"):
        commander.create_publisher(Twist, name, 1)
    settings = BridgeSettings(routes(send="/left /right"))
    bridge = Bridge(create_graph_node(graph, "kit_bridge"), wire, settings, lines.append)
    with bridge:
        bridge.poll()
        assert len(bridge.open_routes) == 2
    assert set(wire.refused) == {"/left", "/right"}
    assert wire.is_closed
    assert any("could not be sent" in line for line in lines)
    bridge.resume()
    assert bridge.is_stopped  # nothing passes once the end has begun


PROGRAM = """
import sys, threading, time
from pathlib import Path
import kit.bridge.shutdown
from kit.bridge.bridge import BridgeSettings
from kit.bridge.wire import Direction, BridgeRoute
from kit.bridge.wire import DryRunWire
from kit.cli.bridge import BridgeRequest, _run_bridge
from kit.inspection.server import InspectionServer
from kit.inspection.sockets import sockets_folder
from kit.msg.geometry_msgs import Twist
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node

hangs, limit_s, folder = sys.argv[1], float(sys.argv[2]), Path(sys.argv[3])
kit.bridge.shutdown.ShutdownDeadline.__init__.__kwdefaults__["limit_s"] = limit_s


class HangingWire(DryRunWire):
    def open_publisher(self, name, interface, qos):
        return lambda data: print("STAND" if not any(data[4:]) else "MOVE", flush=True)

    def close(self):
        print("CLOSING", flush=True)
        if hangs == "close":
            threading.Event().wait()
        if hangs == "thread":  # as Zenoh's threads do: the interpreter waits for them
            threading.Thread(target=threading.Event().wait, name="of-the-wire").start()


graph = Graph(None, log_sink=lambda record: None)
create_graph_node(graph, "pilot").create_publisher(Twist, "/cmd_vel", 1)
server = InspectionServer(graph, sockets_folder(folder), "fake")


def tick():
    while True:
        with graph.lock:
            server.exchange()
        time.sleep(0.005)


threading.Thread(target=tick, daemon=True).start()
settings = BridgeSettings((BridgeRoute.parse(Direction.SEND, "/cmd_vel"),))
_run_bridge(BridgeRequest(lambda: settings, False, False, 0.1, None, folder), "nowhere", HangingWire)
"""


class Program:
    """The verb in a process of its own, over a wire that hangs."""

    def __init__(self, hangs: str, limit_s: float, folder: Path) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM, hangs, str(limit_s), str(folder)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.output = ""
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.output += line

    def wait_for(self, text: str) -> None:
        wait_until(lambda: text in self.output, lambda: f"{text} in {self.output}")

    def exit_code(self) -> int:
        code = self.process.wait(60)
        self._reader.join(60)
        assert self.process.stdout is not None
        self.process.stdout.close()
        return code


@pytest.mark.long
@pytest.mark.parametrize(("hangs", "named"), [("close", "close"), ("thread", "of-the-wire")])
def test_the_verb_ends_though_its_wire_hangs(hangs: str, named: str, tmp_path: Path) -> None:
    program = Program(hangs, 0.5, tmp_path)
    try:
        program.wait_for("0.0/s")  # the route is open
        program.process.send_signal(signal.SIGINT)
        assert program.exit_code() == EXIT_HUNG, program.output
        assert program.output.index("STAND") < program.output.index("did not end within 0.5 s")
        assert named in program.output[program.output.index("did not end") :]
        assert "Traceback" not in program.output
    finally:
        program.process.kill()


@pytest.mark.long
def test_a_second_interrupt_ends_a_verb_whose_wire_hangs(tmp_path: Path) -> None:
    program = Program("close", LONG_S, tmp_path)
    try:
        program.wait_for("0.0/s")  # the route is open
        program.process.send_signal(signal.SIGINT)
        program.wait_for("CLOSING")
        assert "STAND" in program.output
        program.process.send_signal(signal.SIGINT)
        assert program.exit_code() == EXIT_INTERRUPTED
        assert "has not ended" not in program.output
    finally:
        program.process.kill()

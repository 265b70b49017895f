"""The server of a running world: who may come in, what they see, and that they cannot harm it."""

from __future__ import annotations

import os
import select
import socket
import stat
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from kit.host.wire import encode
from kit.inspection import server as server_module
from kit.inspection import sockets
from kit.inspection.client import InspectionClient, ServiceTimeout, WorldDisconnected
from kit.inspection.server import (
    MAX_CLIENTS,
    MAX_FALLING_BEHIND,
    MAX_LATE_NS,
    InspectionServer,
    open_inspection_server,
)
from kit.inspection.sockets import (
    FramedSocket,
    WorldNotFound,
    connect,
    find_world,
    listen,
    running_worlds,
    sockets_folder,
)
from kit.msg.std_msgs import String
from kit.msg.std_srvs import Trigger
from kit.ros.graph.graph import Graph
from kit.ros.log import LogRecord
from kit.ros.node.node import create_graph_node
from tests.waiting import wait_until

TICK_NS = 10_000_000


class Ticking:
    """A graph with a server, ticked in a thread."""

    def __init__(self, folder: Path, name: str = "world") -> None:
        self.log: list[LogRecord] = []
        self.graph = Graph(log_sink=self.log.append)
        self.node = create_graph_node(self.graph, "inside")
        self.server = InspectionServer(self.graph, sockets_folder(folder), name)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._stop.wait(0.0005):
            for _ in range(100):
                self.graph.run_due()
                if not self.server.exchange():
                    break
            self.graph.advance(self.graph.now_ns + TICK_NS)

    def close(self) -> None:
        self._stop.set()
        self._thread.join()
        self.server.close()


@pytest.fixture
def begin(tmp_path: Path) -> Iterator[Callable[..., Ticking]]:
    made: list[Ticking] = []

    def start(name: str = "world", folder: Path = tmp_path) -> Ticking:
        made.append(Ticking(folder, name))
        return made[-1]

    yield start
    for each in made:
        each.close()


def test_only_the_owner_can_see_and_use_the_socket(begin: Callable[..., Ticking]) -> None:
    world = begin()
    assert stat.S_IMODE(world.server.path.stat().st_mode) == 0o600
    assert stat.S_IMODE(world.server.path.parent.stat().st_mode) == 0o700
    line = FramedSocket(connect(world.server.path))
    assert line.peer_user in (None, os.getuid())
    line.close()


def test_one_terminal_too_many_is_refused_and_the_log_says_so(begin: Callable[..., Ticking]) -> None:
    world = begin()
    lines = [connect(world.server.path) for _ in range(MAX_CLIENTS + 1)]
    lines[-1].settimeout(30)
    assert lines[-1].recv(1) == b"", "the server hangs up"
    assert any("another was refused" in record.text for record in world.log)
    for line in lines:
        line.close()


def test_the_newest_world_is_meant_unless_one_is_named(begin: Callable[..., Ticking], tmp_path: Path) -> None:
    folder = sockets_folder(tmp_path)
    with pytest.raises(WorldNotFound, match="kit drive"):
        find_world(folder)
    old = begin("maze")
    os.utime(old.server.path, (1, 1))
    new = begin("house")
    assert find_world(folder).path == new.server.path
    assert find_world(folder, "maze").path == old.server.path
    assert find_world(folder, find_world(folder, "maze").name).path == old.server.path
    with pytest.raises(WorldNotFound, match=r"house-\d+, maze-\d+"):
        find_world(folder, "office")
    new.close()
    assert find_world(folder).path == old.server.path


def test_two_worlds_of_one_name_both_have_a_server(begin: Callable[..., Ticking], tmp_path: Path) -> None:
    assert begin().server.path != begin().server.path
    assert len(running_worlds(sockets_folder(tmp_path))) == 2


def test_the_next_world_clears_away_what_a_killed_one_left_behind(tmp_path: Path) -> None:
    folder = sockets_folder(tmp_path)
    killed, left = listen(folder, "maze")
    killed.close()
    unready = folder / f".maze-{NO_PROCESS}.3{sockets.UNREADY_SUFFIX}"
    unready.touch()
    listener, path = listen(folder, "office")
    with listener:
        assert [entry.name for entry in folder.iterdir()] == [path.name]
        assert not left.exists()


def test_a_search_leaves_a_world_alone_that_only_begins_to_listen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, publish = sockets_folder(tmp_path), sockets._rename_to_free_name

    def search_before(*arguments: object) -> Path:
        assert running_worlds(folder) == []
        return publish(*arguments)  # type: ignore[arg-type]  # as they came

    monkeypatch.setattr(sockets, "_rename_to_free_name", search_before)
    listener, path = listen(folder, "maze")
    with listener:
        assert [world.path for world in running_worlds(folder)] == [path]


NO_PROCESS = 2**22 + 1
"""Above the highest id of a process."""


def test_what_a_killed_world_left_behind_is_cleared_away(
    begin: Callable[..., Ticking], tmp_path: Path
) -> None:
    world = begin()
    left = sockets_folder(tmp_path) / "maze-1.sock"
    dead = socket.socket(socket.AF_UNIX)
    dead.bind(str(left))
    dead.close()
    assert [each.path for each in running_worlds(sockets_folder(tmp_path))] == [world.server.path]
    assert not left.exists()


def test_a_deep_workspace_has_a_server_too(begin: Callable[..., Ticking], tmp_path: Path) -> None:
    deep = tmp_path / ("deep" * 20) / ("deeper" * 10)
    world = begin(folder=deep)
    assert len(os.fsencode(world.server.path)) > 108
    with InspectionClient(find_world(sockets_folder(deep))) as client:
        assert [handle.full_name for handle in client.graph.directory.nodes] == ["/inside"]


def test_a_world_without_a_place_for_a_server_runs_without(tmp_path: Path) -> None:
    (tmp_path / ".running").write_text("no folder")
    log: list[LogRecord] = []
    assert (
        open_inspection_server(Graph(log_sink=log.append), sockets_folder(tmp_path), "maze", lambda: None)
        is None
    )
    assert "cannot connect" in log[0].text


def test_a_client_is_a_node_like_any_other(begin: Callable[..., Ticking], tmp_path: Path) -> None:
    world = begin()
    heard: list[str] = []
    world.node.create_subscription(String, "/to_inside", lambda message: heard.append(message.data), 10)
    with InspectionClient(find_world(sockets_folder(tmp_path))) as client:
        node = client.create_node("outside")
        said: list[str] = []
        node.create_subscription(String, "/to_outside", lambda message: said.append(message.data), 10)
        node.create_service(Trigger, "/ask_outside", lambda request, response: _answered(response))
        publisher = node.create_publisher(String, "/to_inside", 10)
        publisher.publish(String(data="in"))
        threading.Thread(target=_converse, args=(world, client), daemon=True).start()
        client.spin(node, lambda: said)
        assert said == ["answer from outside"]
        assert "/outside" in [handle.full_name for handle in world.graph.directory.nodes]
    wait_until(lambda: "/outside" not in [handle.full_name for handle in world.graph.directory.nodes])
    assert heard == ["in"]


def _answered(response: Trigger.Response) -> Trigger.Response:
    response.message = "answer from outside"
    return response


def _converse(world: Ticking, client: InspectionClient) -> None:
    """Asks the client as soon as it serves, and says aloud what it answered."""
    client = world.node.create_client(Trigger, "/ask_outside")
    publisher = world.node.create_publisher(String, "/to_outside", 10)
    wait_until(client.service_is_ready)
    future = client.call_async(Trigger.Request())
    wait_until(future.done)
    result = future.result()
    assert result is not None
    publisher.publish(String(data=result.message))


def test_messages_arrive_with_the_time_at_which_they_were_published(
    begin: Callable[..., Ticking], tmp_path: Path
) -> None:
    world = begin()
    publisher = world.node.create_publisher(String, "/time", 10)
    world.node.create_timer(0.1, lambda: publisher.publish(String(data=str(world.graph.now_ns))))
    with InspectionClient(find_world(sockets_folder(tmp_path))) as client:
        heard: list[tuple[int, int]] = []
        client.node.create_subscription(
            String, "/time", lambda message: heard.append((int(message.data), client.graph.now_ns)), 100
        )
        time.sleep(0.05)  # it falls behind
        client.spin(client.node, lambda: len(heard) >= 20)
    assert all(said == seen for said, seen in heard)
    assert [heard[i + 1][0] - heard[i][0] for i in range(19)] == [100_000_000] * 19


@pytest.mark.parametrize(
    "nonsense",
    [
        b"\xff\xff\xff\xffmuch",
        b"\0\0\0\4what",
        encode(["reply", 0, None, [["node", 1, "9bad", "/"]]]),
        encode(["reply", 7, None, []]),
        encode(["reply", 0, None, [["message", 5, []]]]),
        encode(["confined", 0]),
    ],
    ids=["too much", "no JSON", "bad name", "no question", "no publisher", "another frame"],
)
def test_a_client_that_sends_nonsense_is_disconnected(nonsense: bytes, begin: Callable[..., Ticking]) -> None:
    world = begin()
    connection = connect(world.server.path)
    connection.sendall(nonsense)
    connection.settimeout(30)
    with suppress(ConnectionResetError):  # it need not have read all we said
        while connection.recv(1 << 16):
            pass
    connection.close()
    wait_until(lambda: world.log)  # the line may be closed before the world knows of the client
    assert "was disconnected" in world.log[-1].text
    wait_until(lambda: world.server.client_count == 0)
    assert [handle.full_name for handle in world.graph.directory.nodes] == ["/inside"]


def test_the_nodes_of_a_client_that_vanishes_are_removed(
    begin: Callable[..., Ticking], tmp_path: Path
) -> None:
    world = begin()
    client = InspectionClient(find_world(sockets_folder(tmp_path)))
    client.create_node("ghost").create_service(Trigger, "/haunt", lambda request, response: response)
    client.wait_for_tick()
    wait_until(lambda: "/haunt" in world.graph.directory.services)
    client._connection.close()
    wait_until(lambda: "/haunt" not in world.graph.directory.services)
    assert world.server.client_count == 0


def test_a_client_that_stops_reading_is_disconnected(
    begin: Callable[..., Ticking], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server_module, "MAX_BACKLOG", 50)
    world = begin()
    publisher = world.node.create_publisher(String, "/much", 10)
    client = InspectionClient(find_world(sockets_folder(tmp_path)))
    client.node.create_subscription(String, "/much", lambda message: None, 10)
    client.wait_for_tick()
    for i in range(60):
        publisher.publish(String(data=str(i)))
    wait_until(lambda: world.server.client_count == 0)
    assert "50 messages behind" in world.log[-1].text
    client.close()


def test_the_client_is_told_when_the_world_ends(begin: Callable[..., Ticking], tmp_path: Path) -> None:
    world = begin()
    client = InspectionClient(find_world(sockets_folder(tmp_path)))
    threading.Timer(0.1, world.close).start()
    with pytest.raises(WorldDisconnected):
        client.spin(client.node)
    client.close()
    assert not world.server.path.exists()
    with pytest.raises(WorldNotFound):
        find_world(sockets_folder(tmp_path))


def test_a_service_that_never_answers_is_not_waited_for_for_ever(
    begin: Callable[..., Ticking], tmp_path: Path
) -> None:
    begin()
    with (
        InspectionClient(find_world(sockets_folder(tmp_path))) as client,
        pytest.raises(ServiceTimeout, match="/silent"),
    ):
        client.call(Trigger, "/silent", Trigger.Request(), timeout_s=0.1)


def test_time_stands_still_while_a_program_enters_the_graph(
    begin: Callable[..., Ticking], tmp_path: Path
) -> None:
    """However long that takes: what it makes then begins at the instant that its clock shows."""
    world = begin()
    fired: list[int] = []
    with InspectionClient(find_world(sockets_folder(tmp_path))) as client:
        client.hold_time()
        began = client.graph.now_ns
        time.sleep(0.1)  # two hundred ticks of this world
        assert world.graph.now_ns == began
        client.node.create_timer(0.05, lambda: fired.append(client.graph.now_ns - began))
        client.spin(client.node, lambda: len(fired) == 3)
        wait_until(lambda: world.graph.now_ns > began + 1_000_000_000)
    assert fired[0] == 50_000_000


class Woken:
    """A client with a timer, at the other end of a world that is ticked by hand."""

    PERIOD_NS = 5 * TICK_NS

    def __init__(self, folder: Path) -> None:
        self.graph = Graph(log_sink=lambda record: None)
        self.server = InspectionServer(self.graph, sockets_folder(folder), "world")
        self._socket = connect(self.server.path)
        self._line = FramedSocket(self._socket)
        wait_until(lambda: self.server.exchange() or self.server.client_count)
        self._line.receive()
        self._seq = 0
        self.answer(0)

    def answer(self, woken_ns: int) -> None:
        """Answers the last question: the client waits until its timer is due once more."""
        self._line.send(["reply", self._seq, woken_ns + self.PERIOD_NS, []])
        wait_until(self._has_taken_note)

    def _has_taken_note(self) -> bool:
        self.server.exchange()
        asked, _, _ = select.select([self._socket], [], [], 0)
        return bool(asked) or not any(self.server.owed_answers().values())

    def pass_time(self, ticks: int) -> None:
        for _ in range(ticks):
            self.graph.advance(self.graph.now_ns + TICK_NS)
            self.server.exchange()

    def wait(self) -> int:
        """The time at which it is woken next [ns]."""
        self.server.exchange()
        _, self._seq, now_ns, _ = self._line.receive()
        return int(now_ns)

    def close(self) -> None:
        self._line.close()
        self.server.close()


@pytest.fixture
def woken(tmp_path: Path) -> Iterator[Woken]:
    client = Woken(tmp_path)
    yield client
    client.close()


def test_a_client_that_answers_late_keeps_the_instants_of_its_timers(woken: Woken) -> None:
    woken.pass_time(5)
    times = [woken.wait()]
    woken.pass_time(400)  # while the machine is busy
    for _ in range(60):
        woken.answer(times[-1])
        times.append(woken.wait())
    assert times == [number * Woken.PERIOD_NS for number in range(1, 62)]


def test_a_client_that_is_slower_than_its_timers_goes_on_at_the_present(woken: Woken) -> None:
    woken.pass_time(5)
    late = []
    for _ in range(60):
        now_ns = woken.wait()
        late.append(woken.graph.now_ns - now_ns)
        woken.pass_time(10)  # twice its period
        woken.answer(now_ns)
    assert max(late) <= (MAX_FALLING_BEHIND + 2) * Woken.PERIOD_NS
    assert late.count(0) > 3


def test_a_client_that_was_stopped_begins_anew_at_the_present(woken: Woken) -> None:
    woken.pass_time(5)
    before_ns = woken.wait()
    woken.pass_time(MAX_LATE_NS // TICK_NS + 100)
    woken.answer(before_ns)
    assert woken.wait() == woken.graph.now_ns


def test_time_stands_still_for_no_client_for_ever(
    begin: Callable[..., Ticking], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server_module, "HOLD_S", 0.2)
    world = begin()
    with InspectionClient(find_world(sockets_folder(tmp_path))) as client:
        client.hold_time()
        began = client.graph.now_ns
        wait_until(lambda: world.graph.now_ns > began + 100 * TICK_NS)


def test_a_client_that_vanishes_while_time_stands_still_lets_it_go_on(
    begin: Callable[..., Ticking], tmp_path: Path
) -> None:
    world = begin()
    client = InspectionClient(find_world(sockets_folder(tmp_path)))
    client.hold_time()
    began = client.graph.now_ns
    client._connection.close()
    wait_until(lambda: world.graph.now_ns > began + 100 * TICK_NS)

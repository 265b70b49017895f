"""A file that is saved, in the ways editors do it, and the exchange of a running version for the new one."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from kit.host.failure import FailureKind, StudentCodeError
from kit.host.file_watcher import EMPTY_S, SETTLED_S, FileWatcher
from kit.host.node_process import NodeProcess
from kit.msg.std_msgs import String
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from tests.host.conftest import QUICK, Student


class WatchedFile:
    """A watched file and a clock that goes when told to."""

    def __init__(self, file: Path) -> None:
        self.now = 0.0
        self.file = file
        self.file.write_text("one")
        self.watch = FileWatcher(file, clock=lambda: self.now)

    def noticed(self, seconds: float = 2.0) -> int:
        """How often a change is noticed within so long a time, looking 50 times a second."""
        count = 0
        for _ in range(round(seconds * 50)):
            self.now += 0.02
            count += self.watch.has_changed()
        return count


@pytest.fixture
def watched(tmp_path: Path) -> WatchedFile:
    return WatchedFile(tmp_path / "work.py")


def test_a_file_as_it_is_has_not_changed(watched: WatchedFile) -> None:
    assert watched.noticed() == 0


def test_what_the_watcher_itself_wrote_is_no_change(watched: WatchedFile) -> None:
    watched.file.write_text("three")
    watched.watch.take_as_known()
    assert watched.noticed() == 0
    watched.file.write_text("seven")
    assert watched.noticed() == 1


def test_a_file_written_in_place(watched: WatchedFile) -> None:
    watched.file.write_text("three")
    assert watched.noticed() == 1
    assert watched.noticed() == 0


def test_a_file_replaced_by_another_of_the_same_size_and_time(watched: WatchedFile) -> None:
    """As on file systems that count seconds."""
    before = watched.file.stat()
    new = watched.file.with_suffix(".new")
    new.write_text("two")
    os.utime(new, ns=(before.st_atime_ns, before.st_mtime_ns))
    new.replace(watched.file)
    assert watched.noticed() == 1


def test_a_file_removed_and_then_written(watched: WatchedFile) -> None:
    watched.file.unlink()
    assert watched.noticed() == 0
    watched.file.write_text("back")
    assert watched.noticed() == 1


def test_a_file_emptied_and_then_filled_is_one_change(watched: WatchedFile) -> None:
    watched.file.write_text("")
    assert watched.noticed(EMPTY_S * 0.8) == 0
    watched.file.write_text("filled")
    assert watched.noticed() == 1


def test_a_file_emptied_for_good(watched: WatchedFile) -> None:
    watched.file.write_text("")
    assert watched.noticed(EMPTY_S * 1.5) == 1


def test_a_file_written_bit_by_bit_is_one_change(watched: WatchedFile) -> None:
    for i in range(20):
        watched.file.write_text("x" * (i + 2))
        assert watched.noticed(SETTLED_S * 0.6) == 0
    assert watched.noticed() == 1


def test_a_file_written_back_as_it_was_is_no_change(watched: WatchedFile) -> None:
    before = watched.file.stat()
    watched.file.write_text("tmp")
    watched.file.write_text("one")
    os.utime(watched.file, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert watched.noticed() == 0


SOURCE = """
from rclpy.node import Node
from std_msgs.msg import String

class Greeter(Node):
    def __init__(self):
        super().__init__("greeter")
        out = self.create_publisher(String, "greetings", 10)
        self.create_timer(0.1, lambda: out.publish(String(data="{word}")))
"""


@pytest.mark.long
def test_the_old_version_drives_until_the_new_one_has_started(student: Student) -> None:
    graph = Graph()
    heard: list[String] = []
    create_graph_node(graph, "watched").create_subscription(String, "/greetings", heard.append, 10)

    def tick(process: NodeProcess) -> list[str]:
        heard.clear()
        graph.advance(graph.now_ns + 100_000_000)
        process.exchange()
        graph.run_due()
        return [message.data for message in heard]

    file = student(SOURCE.format(word="old"))
    old = NodeProcess.start(graph, file, limits=QUICK)
    assert tick(old) == ["old"]

    file.write_text("syntax error here")
    broken = NodeProcess(graph, file, limits=QUICK)
    with pytest.raises(StudentCodeError) as caught:
        broken.wait_until_started()
    broken.close()
    assert (caught.value.failure.kind, caught.value.failure.line) == (FailureKind.SYNTAX, 1)
    assert tick(old) == ["old"]

    file.write_text(SOURCE.format(word="new"))
    new = NodeProcess(graph, file, limits=QUICK)
    assert tick(old) == ["old"]
    while not new.is_started():
        assert tick(old) == ["old"]
    old.close()
    new.join()
    assert set(tick(new)) == {"new"}
    assert tick(new) == ["new"]
    assert [node.get_name() for node in graph.nodes] == ["watched", "greeter"]
    new.close()


def test_of_a_folder_every_file_counts_but_hidden_ones(tmp_path: Path) -> None:
    now = 0.0
    (tmp_path / "maps").mkdir()
    for name in ("world.yaml", "maps/hall.yaml"):
        (tmp_path / name).write_text("one")
    watch = FileWatcher(tmp_path, clock=lambda: now)

    def noticed() -> int:
        nonlocal now
        count = 0
        for _ in range(100):
            now += 0.02
            count += watch.has_changed()
        return count

    assert noticed() == 0
    (tmp_path / "maps" / ".hall.yaml.swp").write_text("an editor's")
    assert noticed() == 0
    (tmp_path / "maps" / "hall.yaml").write_text("two, longer")
    assert noticed() == 1
    (tmp_path / "world.yaml").rename(tmp_path / "other.yaml")
    assert noticed() == 1
    assert noticed() == 0

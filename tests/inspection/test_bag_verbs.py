"""``kit ros bag``: a summary as ROS 2 prints it, and a bag said again in the running world."""

from __future__ import annotations

import signal
from contextlib import closing
from itertools import pairwise
from pathlib import Path

import pytest

import kit
from kit.msg.std_msgs import String
from kit.ros.bag_storage import Storage
from kit.ros.bags import BagRecorder, read_bag, read_messages
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from tests.inspection.conftest import SPEED, Kit, Stage
from tests.tui.input.conftest import Terminal

MAIN = Path(kit.__file__).with_name("__main__.py")

INFO = """
Files:             words_0.mcap
Bag size:          {size}
Storage id:        mcap
ROS Distro:        rosbags
Duration:          0.400000000s
Start:             Jan  1 1970 00:00:01.500000000 (1.500000000)
End:               Jan  1 1970 00:00:01.900000000 (1.900000000)
Messages:          5
Topic information: Topic: /more | Type: std_msgs/msg/String | Count: 0 | Serialization Format: cdr
                   Topic: /words | Type: std_msgs/msg/String | Count: 5 | Serialization Format: cdr
"""


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    return write(tmp_path / "words")


def write(folder: Path, storage: Storage = "mcap") -> Path:
    """Five words, a tenth of a second apart, from 1.5 s on."""
    graph = Graph(1_500_000_000)
    node = create_graph_node(graph, "writer")
    publisher = node.create_publisher(String, "words", 10)
    node.create_publisher(String, "more", 10)
    with BagRecorder(graph, folder, topics=["/words", "/more"], storage=storage):
        for word in "abcde":
            publisher.publish(String(data=word))
            graph.advance(graph.now_ns + 100_000_000)
    return folder


def test_a_bag_s_summary(kit_ros: Kit, bag: Path) -> None:
    out, err, code = kit_ros("bag", "info", str(bag))
    size = f"{(bag / 'words_0.mcap').stat().st_size / 1024:.1f} KiB"
    assert (out, err, code) == (INFO.format(size=size), "", 0)


@pytest.mark.long
@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_bag_is_played_at_its_own_pace(
    storage: Storage, kit_ros: Kit, stage: Stage, tmp_path: Path
) -> None:
    times: list[int] = []
    node = create_graph_node(stage.graph, "clock_watcher")
    node.create_subscription(String, "/demo/orders", lambda message: times.append(stage.graph.now_ns), 10)
    folder = write(tmp_path / "again", storage)
    stage.live.set_factor(1.0)  # a busy machine is late by wall time: the slower the world, the less that is
    try:
        out, err, code = kit_ros(
            "bag", "play", str(folder), "-r", "0.5", "-m", "/words:=/demo/orders", "--topics", "/words"
        )
    finally:
        stage.live.set_factor(SPEED)
        node.destroy_node()
    assert code == 0, out + err
    assert stage.talker.heard[-5:] == list("abcde")
    gaps = [(b - a) / 1e9 for a, b in pairwise(times)]
    assert gaps == pytest.approx([0.2] * 4, abs=0.15), "half as fast, in the world's time"


@pytest.mark.long
@pytest.mark.parametrize(
    ("words", "heard"),
    [
        (("--start-offset", "0.15"), "cde"),
        (("--playback-duration", "0.25"), "abc"),
        (("--start-offset", "0.1", "--playback-duration", "0.15"), "bc"),
        (("--playback-until-sec", "1.65"), "ab"),
        (("--exclude-topics", "/more", "/nothing"), "abcde"),
        (("--exclude-topics", "/words"), ""),
        (("--regex", "^/w"), "abcde"),
        (("-x", "wor"), ""),
        (("--topics", "/words", "/more", "--delay", "0.1"), "abcde"),
    ],
)
def test_a_part_of_a_bag_is_played(
    words: tuple[str, ...], heard: str, kit_ros: Kit, stage: Stage, bag: Path
) -> None:
    texts: list[str] = []
    node = create_graph_node(stage.graph, "listener")
    node.create_subscription(String, "/words", lambda message: texts.append(message.data), 10)
    out, err, code = kit_ros("bag", "play", str(bag), *words)
    node.destroy_node()
    assert code == 0, out + err
    assert "".join(texts) == heard


@pytest.mark.long
@pytest.mark.parametrize(
    "sent", ["SIGINT", "SIGTERM", "SIGHUP", "SIGTERM SIGTERM", "SIGHUP SIGINT", "hang up"]
)
def test_every_end_keeps_what_was_recorded(sent: str, stage: Stage, tmp_path: Path) -> None:
    folder = tmp_path / "heard"
    terminal = Terminal(
        str(MAIN),
        *("ros", "bag", "record", "-a", "-o", str(folder)),
        environment={"KIT_WORKSPACE": str(stage.workspace)},
    )
    with closing(terminal):
        sizes: set[int] = set()

        def has_grown() -> bool:
            """The head of the file alone, which a busy machine may write before the first message, is one size."""
            sizes.update(each.stat().st_size for each in folder.parent.rglob("*.mcap"))
            return len(sizes - {0}) > 1

        terminal.until(has_grown, "messages on the disk")
        if sent == "hang up":
            terminal.hang_up()
        for name in sent.split() if sent != "hang up" else ():
            terminal.process.send_signal(signal.Signals[name])
        terminal.process.wait(60)
    first = "SIGHUP" if sent == "hang up" else sent.split()[0]
    assert terminal.process.returncode == 128 + signal.Signals[first]
    assert sum(1 for _ in read_messages(folder)) == read_bag(folder).count > 0
    assert list(tmp_path.iterdir()) == [folder]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("record",), "-a for all of them"),
        (("record", "-a", "/x"), "-a for all of them"),
        (("record", "-a", "-o", "{bag}", "-s", "sqlite3"), "already exists"),
        (("play", "/nowhere"), "not a bag"),
        (("play", "{bag}", "--topics", "/other"), "it has no topic /other; its topics: /more, /words"),
        (("play", "{bag}", "-m", "/words"), "--remap needs FROM:=TO"),
        (("info", "/nowhere"), "not a bag"),
    ],
)
def test_refusals_explain_themselves(words: tuple[str, ...], message: str, kit_ros: Kit, bag: Path) -> None:
    out, err, code = kit_ros("bag", *(word.format(bag=bag) for word in words))
    assert message in err
    assert code == 1
    assert "Traceback" not in out + err

"""Bags: written as ROS 2 stores them, in the graph's time, and read by others."""

from __future__ import annotations

import os
import shutil
import sqlite3
import struct
import tracemalloc
from collections.abc import Callable
from contextlib import closing, suppress
from dataclasses import fields
from pathlib import Path
from typing import Any, get_args

import lz4.frame
import pytest
import zstandard
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import Reader, Writer
from rosbags.typesys import Stores, get_typestore

from kit.msg import interfaces
from kit.msg.flatland_msgs import Collision, Collisions
from kit.msg.geometry_msgs import Twist, Vector3
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import String
from kit.plain_text import counted
from kit.ros import bag_reader
from kit.ros.bag_storage import MCAP_END, MCAP_MAGIC, RECORD_HEAD, BagError, Storage, restore_bags
from kit.ros.bags import MAX_PENDING, BagRecorder, read_bag, read_messages
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

TICK_NS = 10_000_000


def record(
    folder: Path, storage: Storage = "mcap", topics: list[str] | None = None, ticks: int = 20
) -> Graph:
    """A second of scans, commands, collisions, and a topic that begins late."""
    graph = Graph()
    node = create_graph_node(graph, "robot")
    scans = node.create_publisher(
        LaserScan, "scan", QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    )
    commands = node.create_publisher(Twist, "cmd_vel", 10)
    bumps = node.create_publisher(Collisions, "collisions", 10)
    lasting = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(String, "map_name", lasting).publish(String(data="maze"))
    late = None
    with BagRecorder(graph, folder, storage=storage, topics=topics) as recorder:
        for i in range(ticks):
            scan = LaserScan(range_max=10.0, ranges=[0.1 * i, float("nan")])
            scan.header.stamp.nanosec, scan.header.frame_id = graph.now_ns, "laser"
            scans.publish(scan)
            commands.publish_without_copy(Twist(linear=Vector3(x=0.5 * i)))
            bumps.publish(Collisions(collisions=[Collision(entity_a="serp", magnitude_forces=[1.5])]))
            if i == ticks // 2:
                late = node.create_publisher(String, "late", 10)
            if late is not None:
                late.publish(String(data=str(i)))
            recorder.exchange()
            graph.advance(graph.now_ns + TICK_NS)
    return graph


def test_an_independent_reader_decodes_the_messages(tmp_path: Path) -> None:
    record(tmp_path / "bag")
    with (tmp_path / "bag" / "bag_0.mcap").open("rb") as opened:
        messages = make_reader(opened, decoder_factories=[DecoderFactory()]).iter_decoded_messages()
        found = [(channel.topic, message.log_time, decoded) for _, channel, message, decoded in messages]
    by_topic: dict[str, list[Any]] = {}
    for topic, time_ns, decoded in found:
        by_topic.setdefault(topic, []).append((time_ns, decoded))
    assert [time for time, _ in by_topic["/scan"]] == [i * TICK_NS for i in range(20)]
    assert all(scan.header.stamp.nanosec == time for time, scan in by_topic["/scan"])
    assert [scan.ranges[0] for _, scan in by_topic["/scan"]] == pytest.approx([0.1 * i for i in range(20)])
    assert all(scan.ranges[1] != scan.ranges[1] for _, scan in by_topic["/scan"])
    assert [twist.linear.x for _, twist in by_topic["/cmd_vel"]] == [0.5 * i for i in range(20)]
    assert by_topic["/collisions"][0][1].collisions[0].magnitude_forces == [1.5]
    assert [text.data for _, text in by_topic["/map_name"]] == ["maze"]
    assert [text.data for _, text in by_topic["/late"]] == [str(i) for i in range(11, 20)]


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_what_is_written_is_read(storage: Storage, tmp_path: Path) -> None:
    record(tmp_path / "bag", storage)
    bag = read_bag(tmp_path / "bag")
    assert (bag.storage, bag.start_ns, bag.duration_ns) == (storage, 0, 19 * TICK_NS)
    counts = {topic.name: topic.count for topic in bag.topics}
    assert counts["/scan"] == counts["/cmd_vel"] == counts["/collisions"] == 20
    qos = {topic.name: topic.qos for topic in bag.topics}
    assert qos["/scan"].is_best_effort
    assert qos["/map_name"].is_transient_local
    found = list(read_messages(tmp_path / "bag", ["/cmd_vel", "/collisions"]))
    assert [time for time, topic, _ in found if topic == "/cmd_vel"] == [i * TICK_NS for i in range(20)]
    assert sorted(found, key=lambda entry: entry[0]) == found
    twists: list[Any] = [message for _, topic, message in found if topic == "/cmd_vel"]
    assert twists == [Twist(linear=Vector3(x=0.5 * i)) for i in range(20)]
    with Reader(tmp_path / "bag") as reader:
        assert reader.message_count == bag.count


def test_humble_reads_sqlite3_with_its_own_definitions(tmp_path: Path) -> None:
    record(tmp_path / "bag", "sqlite3")
    store = get_typestore(Stores.ROS2_HUMBLE)
    with Reader(tmp_path / "bag") as reader:
        connection = next(each for each in reader.connections if each.topic == "/scan")
        assert connection.digest == store.hash_rihs01("sensor_msgs/msg/LaserScan")
        _, _, data = next(iter(reader.messages([connection])))
        scan: Any = store.deserialize_cdr(data, "sensor_msgs/msg/LaserScan")
    assert scan.header.frame_id == "laser"
    assert "version: 8" in (tmp_path / "bag" / "metadata.yaml").read_text()


def test_chosen_topics_alone_are_recorded_and_missing_ones_known(tmp_path: Path) -> None:
    record(tmp_path / "bag", topics=["/cmd_vel"])
    assert [topic.name for topic in read_bag(tmp_path / "bag").topics] == ["/cmd_vel"]
    graph = Graph()
    with BagRecorder(graph, tmp_path / "none", topics=["/x", "/y"]) as recorder:
        assert recorder.missing == ("/x", "/y")
    assert read_bag(tmp_path / "none").count == 0
    assert list(read_messages(tmp_path / "none")) == []
    assert [handle.name for handle in graph.directory.nodes] == []


def test_nothing_is_overwritten_and_nothing_appears_before_it_is_complete(tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    recorder = BagRecorder(Graph(), folder)
    assert not folder.exists()
    recorder.close()
    recorder.close()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bag"]
    with pytest.raises(BagError, match="already exists"):
        BagRecorder(Graph(), folder)
    with pytest.raises(BagError, match="no bag can be written there"):
        BagRecorder(Graph(), Path("/proc/nowhere/bag"))


@pytest.mark.parametrize("storage", get_args(Storage))
@pytest.mark.parametrize("torn", [0, 1, 40])
def test_what_a_killed_recording_left_is_restored_at_the_next_start(
    tmp_path: Path, storage: Storage, torn: int
) -> None:
    graph = Graph()
    publisher = create_graph_node(graph, "robot").create_publisher(String, "words", 10)
    killed = BagRecorder(graph, tmp_path / "bag", storage=storage)
    for number in range(3):
        publisher.publish(String(data=str(number)))
        if number < 2:
            killed._flushed_s = -10.0  # as if a second had passed
            killed.exchange()
    part = tmp_path / ".bag.part"
    with BagRecorder(Graph(), tmp_path / "other") as other:
        assert other.notices == (), "it is still being written"
    with pytest.raises(BagError, match="another program is writing it"):
        BagRecorder(Graph(), tmp_path / "bag")
    with pytest.raises(BagError, match="records this bag now"):
        read_bag(tmp_path / "bag")
    left = tmp_path / "left"
    shutil.copytree(part, left / part.name)  # what is on the disk at this moment
    data = next((left / part.name / "bag_0").glob("bag_0.*"))
    if torn and storage == "mcap":
        data.write_bytes(data.read_bytes()[:-torn])
    (notice,) = restore_bags(left)
    kept = [message.data for _, _, message in read_messages(left / "bag", ["/words"])]
    assert (
        kept == ["0", "1"] if storage == "sqlite3" or torn < 40 else kept == ["0"]
    )  # 1: of the index after it
    assert counted(len(kept), "message") in notice
    assert sorted(path.name for path in left.iterdir()) == ["bag"]
    assert list(restore_bags(left)) == []
    killed.close()


def test_the_name_that_is_recorded_next_stays_free(tmp_path: Path) -> None:
    publisher = create_graph_node(graph := Graph(), "robot").create_publisher(String, "words", 10)
    killed = BagRecorder(graph, tmp_path / "bag")
    publisher.publish(String(data="kept"))
    killed._flushed_s = -10.0
    killed.exchange()
    shutil.copytree(tmp_path / ".bag.part", tmp_path / "left" / ".bag.part")
    killed.close()
    with BagRecorder(Graph(), tmp_path / "left" / "bag") as recorder:
        assert "bag-2" in recorder.notices[0]
    assert read_bag(tmp_path / "left" / "bag").count == 0
    assert read_bag(tmp_path / "left" / "bag-2").count == 1


@pytest.mark.parametrize("lost", [2, MAX_PENDING])
def test_a_full_disk_ends_the_bag_and_not_the_publisher(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, lost: int
) -> None:
    """At once where many messages are to be written, else at the end."""
    graph = Graph()
    publisher = create_graph_node(graph, "robot").create_publisher(String, "words", 10)
    recorder = BagRecorder(graph, tmp_path / "bag")
    for _ in range(MAX_PENDING):
        publisher.publish(String(data="written"))

    write, errors = Writer.write, [OSError(28, "No space left on device")]

    def full(*arguments: Any) -> None:
        if errors:
            raise errors.pop()
        write(*arguments)

    monkeypatch.setattr(Writer, "write", full)
    for _ in range(lost):
        publisher.publish(String(data="lost"))
    assert (recorder.failure is not None) == (lost == MAX_PENDING)
    with pytest.raises(BagError, match=r"ends early.*No space left on device"):
        recorder.close()
    assert read_bag(tmp_path / "bag").count == recorder.count == MAX_PENDING


@pytest.mark.parametrize("definition", ["", "no definition at all"])
def test_unknown_types_are_read_by_what_the_bag_says_of_them_or_left_out_by_name(
    tmp_path: Path, definition: str
) -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    unknown = "rosbag2_interfaces/msg/ReadSplitEvent"
    with Writer(tmp_path / "bag", version=9) as writer:
        text = definition or store.generate_msgdef(unknown, ros_version=2)[0]
        connection = writer.add_connection("/events", unknown, msgdef=text, rihs01=store.hash_rihs01(unknown))
        split: Any = store.types[unknown]
        data = store.serialize_cdr(split(*("text" for _ in fields(split))), unknown)
        writer.write(connection, 5, bytes(data))
    skipped: list[tuple[str, str]] = []
    found = list(read_messages(tmp_path / "bag", skipped=lambda *about: skipped.append(about)))
    if definition:
        assert (found, skipped) == ([], [("/events", unknown)])
    else:
        ((_, _, message),) = found
        assert set(message.get_fields_and_field_types()) == {"closed_file", "opened_file", "node_name"}
        assert message.closed_file == "text"


def test_a_message_of_a_package_is_read_where_nobody_knows_the_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its definition and those of the messages in it are in the bag."""
    folder = tmp_path / "far_msgs"
    (folder / "msg").mkdir(parents=True)
    (folder / "msg" / "Place.msg").write_text("string<=10 name here  # a default\ngeometry_msgs/Point at\n")
    (folder / "msg" / "Reading.msg").write_text("uint8 HIGH=2\nPlace[<=3] places\nfloat64[2] range\n")
    (folder / "action").mkdir()
    (folder / "action" / "Read.action").write_text("---\n---\nReading now\n")
    monkeypatch.setattr(interfaces, "_registry", interfaces._InterfaceRegistry())
    interfaces.register_packages({"far_msgs": str(folder)})
    feedback = interfaces.find_action("far_msgs/action/Read").Impl.FeedbackMessage
    graph = Graph()
    publisher = create_graph_node(graph, "sensor").create_publisher(feedback, "readings", 10)
    with BagRecorder(graph, tmp_path / "bag"):
        message = feedback()
        place = interfaces.find_message("far_msgs/msg/Place")(name="there")
        message.feedback.now.places = [place]
        publisher.publish(message)
    monkeypatch.setattr(interfaces, "_registry", interfaces._InterfaceRegistry())
    ((_, _, found),) = read_messages(tmp_path / "bag", ["/readings"])
    assert type(found).__ros_type__ == "far_msgs/action/Read_FeedbackMessage"
    assert found.feedback.now.places[0].name == "there"
    assert type(found.feedback.now).HIGH == 2


@pytest.mark.parametrize("damage", ["no metadata", "broken metadata", "no data", "cut data", "no folder"])
def test_damaged_bags_are_refused(damage: str, tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    record(folder)
    metadata, data = folder / "metadata.yaml", folder / "bag_0.mcap"
    if damage == "no metadata":
        metadata.unlink()
    elif damage == "broken metadata":
        metadata.write_text("rosbag2_bagfile_information: [")
    elif damage == "no data":
        data.unlink()
    elif damage == "cut data":
        data.write_bytes(data.read_bytes()[:200])
    else:
        folder = tmp_path / "other"
    with pytest.raises(BagError, match=r"bag|other"):
        list(read_messages(folder))


@pytest.mark.parametrize("name", ["metadata.yaml", "bag_0.mcap", "beside"])
def test_a_pipe_in_a_bag_holds_no_reader(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    record(folder)
    (folder / name).unlink(missing_ok=True)
    os.mkfifo(folder / name)
    with pytest.raises(BagError):
        read_bag(folder)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("nanoseconds: ", "nanoseconds: [1] # "),
        ("type: std_msgs/msg/", "type: 1.5 # "),
        ("message_count: ", "message_count: many # "),
        ("offered_qos_profiles: ", "offered_qos_profiles: {} # "),
    ],
)
def test_a_bag_whose_summary_has_other_types_is_refused(old: str, new: str, tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    record(folder)
    metadata = folder / "metadata.yaml"
    whole = metadata.read_text()
    if old not in whole:
        pytest.skip("this storage keeps it elsewhere")
    metadata.write_text(whole.replace(old, new))
    with suppress(BagError):
        assert read_bag(folder)
        assert list(read_messages(folder)) is not None


@pytest.mark.parametrize("packed", [lz4.frame.compress, zstandard.compress], ids=["lz4", "zstd"])
@pytest.mark.parametrize("said", [100, 1 << 40], ids=["says little", "says much"])
def test_a_chunk_that_unpacks_to_more_than_it_may_takes_no_memory(
    packed: Callable[[bytes], bytes], said: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bag_reader, "MAX_UNPACKED", 1 << 20)
    folder = tmp_path / "bag"
    record(folder)
    data = packed(bytes(64 << 20))
    name = packed.__module__.split(".")[0].replace("zstandard", "zstd").encode()

    def part(of: bytes) -> bytes:
        return struct.pack("<I", len(of)) + of

    chunk = struct.pack("<QQQI", 0, 1, said, 0) + part(name) + struct.pack("<Q", len(data)) + data
    head = part(b"ros2") + part(b"test")
    (folder / "bag_0.mcap").write_bytes(
        MCAP_MAGIC
        + RECORD_HEAD.pack(1, len(head))
        + head
        + RECORD_HEAD.pack(6, len(chunk))
        + chunk
        + MCAP_END
    )
    tracemalloc.start()
    try:
        with pytest.raises(BagError, match="come out of"):
            read_bag(folder)
        assert tracemalloc.get_traced_memory()[1] < 16 << 20
    finally:
        tracemalloc.stop()


def test_a_bag_that_is_compressed_as_a_whole_fills_no_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "bag"
    record(folder, "sqlite3")
    whole = (folder / "bag_0.db3").read_bytes()
    metadata = folder / "metadata.yaml"
    metadata.write_text(
        metadata.read_text()
        .replace("compression_format: ''", "compression_format: zstd")
        .replace("compression_mode: ''", "compression_mode: file")
        .replace("bag_0.db3", "bag_0.db3.zstd")
    )
    (folder / "bag_0.db3").unlink()
    (folder / "bag_0.db3.zstd").write_bytes(zstandard.compress(whole))
    assert list(read_messages(folder))
    monkeypatch.setattr(bag_reader, "MAX_UNPACKED_FILE", len(whole) - 1)
    with pytest.raises(BagError, match="come out of"):
        read_bag(folder)


@pytest.mark.parametrize(
    "change",
    [
        (
            "ALTER TABLE messages RENAME TO other; CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id INTEGER,"
            " timestamp INTEGER, data BLOB AS (zeroblob(900000000)));"
            " INSERT INTO messages SELECT id, topic_id, timestamp FROM other"
        ),
        (
            "ALTER TABLE topics RENAME TO other; CREATE VIEW endless AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL"
            " SELECT x + 1 FROM c) SELECT x AS rowid, x AS id, x AS name FROM c;"
            " CREATE VIRTUAL TABLE topics USING fts5(id, name, content=endless)"
        ),
    ],
    ids=["computed column", "virtual table"],
)
def test_a_bag_whose_rows_are_computed_is_refused(change: str, tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    record(folder, "sqlite3")
    with closing(sqlite3.connect(folder / "bag_0.db3")) as database:
        database.executescript(change)
    with pytest.raises(BagError, match="computed"):
        read_bag(folder)

"""Bags are written and read message by message, as rosbag2_py does it."""

from __future__ import annotations

import gc
import itertools
from pathlib import Path
from typing import Any

import pytest
import yaml

from kit.msg.std_msgs import Int32, String
from kit.ros import bag_files as rosbag2_py
from kit.ros.bags import read_bag, read_messages
from kit.ros.serialization import deserialize_message, serialize_message

TOPICS = {"/count": Int32, "/words": String}


def write(
    uri: Path, storage: str = "", *, close: bool = True, from_ns: int = 0
) -> rosbag2_py.SequentialWriter:
    writer = rosbag2_py.SequentialWriter()
    writer.open(
        rosbag2_py.StorageOptions(uri=str(uri), storage_id=storage), rosbag2_py.ConverterOptions("cdr", "cdr")
    )
    for number, topic in enumerate(TOPICS):
        kind = f"std_msgs/msg/{TOPICS[topic].__name__}"
        writer.create_topic(
            rosbag2_py.TopicMetadata(id=number, name=topic, type=kind, serialization_format="cdr")
        )
    for i in range(10):
        writer.write("/count", serialize_message(Int32(data=i)), from_ns + i * 1000)
        writer.write("/words", serialize_message(String(data=str(i))), from_ns + i * 1000 + 500)
    if close:
        writer.close()
    return writer


def read(reader: rosbag2_py.SequentialReader) -> list[tuple[str, object, int]]:
    found = []
    while reader.has_next():
        topic, data, time_ns = reader.read_next()
        found.append((topic, deserialize_message(data, TOPICS[topic]).data, time_ns))
    return found


def opened(uri: Path, storage: str = "") -> rosbag2_py.SequentialReader:
    reader = rosbag2_py.SequentialReader()
    reader.open(rosbag2_py.StorageOptions(str(uri), storage), rosbag2_py.ConverterOptions("", ""))
    return reader


EXPECTED = list(
    itertools.chain.from_iterable(
        [("/count", i, i * 1000), ("/words", str(i), i * 1000 + 500)] for i in range(10)
    )
)


def join(folder: Path, *bags: Path) -> None:
    """Makes one bag of several files, as ROS 2 does where a limit of size or duration is given."""
    folder.mkdir()
    joined: dict[str, Any] = {}
    for number, bag in enumerate(bags):
        told = yaml.safe_load((bag / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
        (file,) = told["relative_file_paths"]
        name = f"{folder.name}_{number}{Path(file).suffix}"
        (bag / file).rename(folder / name)
        part = {**told["files"][0], "path": name}
        if not joined:
            joined = {**told, "relative_file_paths": [name], "files": [part]}
            continue
        joined["relative_file_paths"].append(name)
        joined["files"].append(part)
        joined["message_count"] += told["message_count"]
        for each, more in zip(
            joined["topics_with_message_count"], told["topics_with_message_count"], strict=True
        ):
            each["message_count"] += more["message_count"]
        end_ns = told["starting_time"]["nanoseconds_since_epoch"] + told["duration"]["nanoseconds"]
        joined["duration"] = {"nanoseconds": end_ns - joined["starting_time"]["nanoseconds_since_epoch"]}
    (folder / "metadata.yaml").write_text(yaml.safe_dump({"rosbag2_bagfile_information": joined}))


@pytest.mark.parametrize("storage", sorted(rosbag2_py.get_registered_writers()))
def test_a_bag_of_several_files_is_read_as_one(tmp_path: Path, storage: str) -> None:
    parts = [tmp_path / f"part{number}" for number in range(3)]
    for number, part in enumerate(parts):
        write(part, storage, from_ns=number * 20_000)
    join(tmp_path / "bag", *parts)
    shifted = [
        (topic, value, time_ns + number * 20_000) for number in range(3) for topic, value, time_ns in EXPECTED
    ]
    reader = opened(tmp_path / "bag", storage)
    assert read(reader) == shifted
    reader.seek(40_000)
    assert read(reader) == shifted[40:]
    bag = read_bag(tmp_path / "bag")
    assert (bag.count, len(bag.files)) == (60, 3)
    times = [time_ns for time_ns, _, _ in read_messages(tmp_path / "bag")]
    assert times == [time_ns for *_, time_ns in shifted]


@pytest.mark.parametrize("storage", sorted(rosbag2_py.get_registered_writers()))
def test_what_is_written_is_read(tmp_path: Path, storage: str) -> None:
    write(tmp_path / "bag", storage)
    reader = opened(tmp_path / "bag", storage)
    assert {each.name: each.type for each in reader.get_all_topics_and_types()} == {
        topic: f"std_msgs/msg/{cls.__name__}" for topic, cls in TOPICS.items()
    }
    assert read(reader) == EXPECTED
    with pytest.raises(RuntimeError):
        reader.read_next()
    assert [message.data for _, _, message in read_messages(tmp_path / "bag")] == [
        each[1] for each in EXPECTED
    ]
    found = rosbag2_py.Info().read_metadata(str(tmp_path / "bag"), storage)
    assert (found.message_count, found.storage_identifier, found.duration.nanoseconds) == (20, storage, 9500)
    assert {
        each.topic_metadata.name: each.message_count for each in found.topics_with_message_count
    } == dict.fromkeys(TOPICS, 10)


def test_topics_are_chosen_and_times_sought(tmp_path: Path) -> None:
    write(tmp_path / "bag")
    reader = opened(tmp_path / "bag")
    reader.read_next()
    reader.set_filter(rosbag2_py.StorageFilter(topics=["/words"]))
    assert read(reader) == [each for each in EXPECTED if each[0] == "/words"]
    reader.reset_filter()
    reader.seek(8000)
    assert read(reader) == [each for each in EXPECTED if each[2] >= 8000]
    reader.set_filter(rosbag2_py.StorageFilter(topics_regex="/c.*"))
    reader.seek(9000)
    assert read(reader) == [("/count", 9, 9000)]


def test_a_writer_that_is_gone_has_completed_its_bag(tmp_path: Path) -> None:
    writer = write(tmp_path / "bag", close=False)
    assert not (tmp_path / "bag").exists()
    del writer
    gc.collect()
    assert read(opened(tmp_path / "bag")) == EXPECTED


def test_a_topic_of_humble(tmp_path: Path) -> None:
    topic = rosbag2_py.TopicMetadata("chatter", "std_msgs/msg/String", "cdr")
    assert (topic.name, topic.type, topic.serialization_format) == ("chatter", "std_msgs/msg/String", "cdr")


def test_what_cannot_be_done_is_said(tmp_path: Path) -> None:
    writer = write(tmp_path / "bag", close=False)
    with pytest.raises(RuntimeError, match="create_topic"):
        writer.write("/other", b"", 0)
    with pytest.raises(RuntimeError, match="other/msg/Thing"):
        writer.create_topic(rosbag2_py.TopicMetadata(0, "/other", "other/msg/Thing"))
    second = rosbag2_py.SequentialWriter()
    with pytest.raises(RuntimeError, match="another program"):  # two writers on one name
        second.open(rosbag2_py.StorageOptions(str(tmp_path / "bag")))
    writer.close()
    with pytest.raises(RuntimeError, match="exists"):
        second.open(rosbag2_py.StorageOptions(str(tmp_path / "bag")))
    with pytest.raises(RuntimeError, match="not a bag"):
        opened(tmp_path)
    with pytest.raises(RuntimeError, match="mcap"):
        opened(tmp_path / "bag", "sqlite3")
    with pytest.raises(RuntimeError, match="xml"):
        second.open(rosbag2_py.StorageOptions(str(tmp_path / "x")), rosbag2_py.ConverterOptions("xml", "xml"))

"""Records what it publishes with rosbag2_py, reads it back by type, filters it, seeks, and plays it again."""

import os
import shutil
import tempfile

import rclpy
import rosbag2_py
from geometry_msgs.msg import Vector3Stamped
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.utilities import get_message
from std_msgs.msg import Float64, String


class Recorder(Node):
    def __init__(self, uri):
        super().__init__("flight_recorder")
        self.writer = rosbag2_py.SequentialWriter()
        self.writer.open(
            rosbag2_py.StorageOptions(uri=uri, storage_id="sqlite3"),
            rosbag2_py.ConverterOptions(input_serialization_format="cdr", output_serialization_format="cdr"),
        )
        for number, (topic, kind) in enumerate(
            (("height", "std_msgs/msg/Float64"), ("wind", "geometry_msgs/msg/Vector3Stamped"), ("log", "std_msgs/msg/String"))
        ):
            self.writer.create_topic(
                rosbag2_py.TopicMetadata(id=number, name=topic, type=kind, serialization_format="cdr")
            )
        self.height = self.create_publisher(Float64, "height", 10)
        self.create_subscription(Float64, "height", lambda message: self.write("height", message), 10)
        self.count = 0
        self.timer = self.create_timer(0.1, self.tick)

    def write(self, topic, message):
        self.writer.write(topic, serialize_message(message), self.get_clock().now().nanoseconds)

    def tick(self):
        self.height.publish(Float64(data=self.count * 0.5))
        if self.count % 5 == 0:
            wind = Vector3Stamped()
            wind.header.stamp = self.get_clock().now().to_msg()
            wind.vector.x = float(self.count)
            self.write("wind", wind)
        self.count += 1
        if self.count == 20:
            self.write("log", String(data="landed"))
        if self.count == 22:
            self.timer.cancel()
            raise SystemExit


def open_reader(uri):
    reader = rosbag2_py.SequentialReader()
    reader.open(
        rosbag2_py.StorageOptions(uri=uri, storage_id="sqlite3"),
        rosbag2_py.ConverterOptions("", ""),
    )
    return reader


def main():
    rclpy.init()
    folder = tempfile.mkdtemp()
    uri = os.path.join(folder, "flight")
    node = Recorder(uri)
    try:
        rclpy.spin(node)
    except SystemExit:
        pass
    del node.writer
    reader = open_reader(uri)
    types = {each.name: each.type for each in reader.get_all_topics_and_types()}
    print("types", sorted(types.items()))
    heights, stamps = [], []
    while reader.has_next():
        topic, data, stamp = reader.read_next()
        stamps.append(stamp)
        message = deserialize_message(data, get_message(types[topic]))
        if topic == "height":
            heights.append(message.data)
        elif topic == "log":
            print("log says", message.data)
    print(f"{len(heights)} heights up to {max(heights)}, in order {stamps == sorted(stamps)}")
    reader = open_reader(uri)
    reader.set_filter(rosbag2_py.StorageFilter(topics=["wind"]))
    winds = []
    while reader.has_next():
        _, data, _ = reader.read_next()
        winds.append(deserialize_message(data, Vector3Stamped).vector.x)
    print("winds", winds)
    reader = open_reader(uri)
    reader.seek(stamps[0] + 1_000_000_000)
    rest = 0
    while reader.has_next():
        reader.read_next()
        rest += 1
    print(f"after a second {rest < len(stamps)} {rest > 5}")
    metadata = rosbag2_py.Info().read_metadata(uri, "sqlite3")
    print(f"metadata: {metadata.message_count == len(stamps)} {metadata.storage_identifier} {len(metadata.topics_with_message_count)}")
    counts = {each.topic_metadata.name: each.message_count for each in metadata.topics_with_message_count}
    print("counts", counts["wind"], counts["log"])
    try:
        rosbag2_py.SequentialReader().open(
            rosbag2_py.StorageOptions(uri=os.path.join(folder, "missing"), storage_id="sqlite3"),
            rosbag2_py.ConverterOptions("", ""),
        )
    except RuntimeError as error:
        print("caught", type(error).__name__)
    shutil.rmtree(folder)
    rclpy.shutdown()


if __name__ == "__main__":
    main()

import os
import tempfile

import rclpy
import rosbag2_py
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.utilities import get_message


class BagRecorder(Node):
    def __init__(self, uri):
        super().__init__("bag_recorder")
        self.writer = rosbag2_py.SequentialWriter()
        self.writer.open(
            rosbag2_py.StorageOptions(uri=uri, storage_id="sqlite3"), rosbag2_py.ConverterOptions("", ""))
        self.writer.create_topic(rosbag2_py.TopicMetadata(
            id=0, name="odom", type="nav_msgs/msg/Odometry", serialization_format="cdr"))
        self.count = 0
        self.create_subscription(Odometry, "odom", self.keep, 10)

    def keep(self, msg):
        self.writer.write("odom", serialize_message(msg), self.get_clock().now().nanoseconds)
        self.count += 1


def read(uri):
    reader = rosbag2_py.SequentialReader()
    reader.open(
        rosbag2_py.StorageOptions(uri=uri, storage_id="sqlite3"),
        rosbag2_py.ConverterOptions(input_serialization_format="cdr", output_serialization_format="cdr"))
    types = {t.name: t.type for t in reader.get_all_topics_and_types()}
    reader.set_filter(rosbag2_py.StorageFilter(topics=["odom"]))
    while reader.has_next():
        topic, data, stamp = reader.read_next()
        yield topic, deserialize_message(data, get_message(types[topic])), stamp


def main():
    uri = os.path.join(tempfile.mkdtemp(), "my_bag")
    rclpy.init()
    node = BagRecorder(uri)
    while node.count < 100:
        rclpy.spin_once(node)
    del node.writer
    rclpy.shutdown()
    got = list(read(uri))
    print(f"{len(got)} messages of {got[0][0]}, {type(got[0][1]).__name__}, frame {got[-1][1].header.frame_id}")
    print("rising:", all(a[2] <= b[2] for a, b in zip(got, got[1:])), f"{(got[-1][2] - got[0][2]) / 1e9:.1f} s")
    info = rosbag2_py.Info().read_metadata(uri, "sqlite3")
    print("metadata", info.message_count, [t.topic_metadata.name for t in info.topics_with_message_count])


main()

"""rosbag2_py: write 30 messages, read them again with a filter, by the tutorial's pattern."""
import os
import shutil
import tempfile
import rclpy
import rosbag2_py
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.utilities import get_message
from std_msgs.msg import Int32, String

folder = os.path.join(tempfile.mkdtemp(), "my_bag")


class Rec(Node):
    def __init__(self):
        super().__init__("rec")
        self.writer = rosbag2_py.SequentialWriter()
        self.writer.open(rosbag2_py.StorageOptions(uri=folder, storage_id="mcap"), rosbag2_py.ConverterOptions("", ""))
        self.writer.create_topic(rosbag2_py.TopicMetadata(id=0, name="num", type="std_msgs/msg/Int32", serialization_format="cdr"))
        self.writer.create_topic(rosbag2_py.TopicMetadata(id=1, name="txt", type="std_msgs/msg/String", serialization_format="cdr"))
        self.n = 0
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.n += 1
        now = self.get_clock().now().nanoseconds
        self.writer.write("num", serialize_message(Int32(data=self.n)), now)
        if self.n % 3 == 0:
            self.writer.write("txt", serialize_message(String(data=f"n{self.n}")), now)
        if self.n == 30:
            del self.writer
            raise SystemExit


rclpy.init()
try:
    rclpy.spin(Rec())
except SystemExit:
    pass
reader = rosbag2_py.SequentialReader()
reader.open(rosbag2_py.StorageOptions(uri=folder, storage_id="mcap"), rosbag2_py.ConverterOptions("cdr", "cdr"))
types = {t.name: t.type for t in reader.get_all_topics_and_types()}
count, stamps = {}, []
while reader.has_next():
    topic, data, stamp = reader.read_next()
    msg = deserialize_message(data, get_message(types[topic]))
    count[topic] = count.get(topic, 0) + 1
    stamps.append(stamp)
print(sorted(count.items()), sorted(types.items()), "%.1f" % ((stamps[-1] - stamps[0]) / 1e9), stamps == sorted(stamps))
reader = rosbag2_py.SequentialReader()
reader.open_uri(folder)
reader.set_filter(rosbag2_py.StorageFilter(topics=["txt"]))
got = []
while reader.has_next():
    t, d, s = reader.read_next()
    got.append(deserialize_message(d, String).data)
print(got[0], got[-1], len(got), rosbag2_py.Info().read_metadata(folder, "mcap").message_count)
shutil.rmtree(folder)
rclpy.shutdown()

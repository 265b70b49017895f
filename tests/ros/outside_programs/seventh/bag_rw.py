"""Writes a bag from a subscription (sequential writer), then reads it back and counts."""
import shutil
import sys
import tempfile
from pathlib import Path

import rclpy
import rosbag2_py
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.utilities import get_message
from sensor_msgs.msg import JointState


class Recorder(Node):
    def __init__(self, uri):
        super().__init__('simple_bag_recorder')
        self.writer = rosbag2_py.SequentialWriter()
        self.writer.open(rosbag2_py.StorageOptions(uri=uri, storage_id='mcap'),
                         rosbag2_py.ConverterOptions(input_serialization_format='cdr', output_serialization_format='cdr'))
        self.writer.create_topic(rosbag2_py.TopicMetadata(id=0, name='joints', type='sensor_msgs/msg/JointState', serialization_format='cdr'))
        self.create_subscription(JointState, 'joints', self.on_joints, 10)
        self.n = 0

    def on_joints(self, msg):
        self.writer.write('joints', serialize_message(msg), self.get_clock().now().nanoseconds)
        self.n += 1


class Source(Node):
    def __init__(self):
        super().__init__('source')
        self.pub = self.create_publisher(JointState, 'joints', 10)
        self.k = 0
        self.create_timer(0.05, self.tick)

    def tick(self):
        m = JointState(name=['left', 'right'], position=[0.1 * self.k, -0.1 * self.k])
        m.header.stamp = self.get_clock().now().to_msg()
        self.pub.publish(m)
        self.k += 1


def main():
    rclpy.init()
    folder = Path(tempfile.mkdtemp())
    uri = str(folder / 'joints_bag')
    recorder, source = Recorder(uri), Source()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(recorder)
    executor.add_node(source)
    while recorder.n < 40:
        executor.spin_once(timeout_sec=1.0)
    del recorder.writer
    print('files', sorted(p.suffix for p in Path(uri).iterdir()))

    info = rosbag2_py.Info().read_metadata(uri, '')
    print('messages', info.message_count, [t.topic_metadata.name for t in info.topics_with_message_count])

    reader = rosbag2_py.SequentialReader()
    reader.open(rosbag2_py.StorageOptions(uri=uri, storage_id='mcap'), rosbag2_py.ConverterOptions('', ''))
    types = {t.name: t.type for t in reader.get_all_topics_and_types()}
    reader.set_filter(rosbag2_py.StorageFilter(topics=['joints']))
    positions, stamps = [], []
    while reader.has_next():
        topic, data, t = reader.read_next()
        msg = deserialize_message(data, get_message(types[topic]))
        positions.append(list(msg.position))
        stamps.append(t)
    print('read', len(positions), round(positions[-1][0] - positions[0][0], 6), stamps == sorted(stamps))
    reader2 = rosbag2_py.SequentialReader()
    reader2.open_uri(uri) if hasattr(reader2, 'open_uri') else reader2.open(rosbag2_py.StorageOptions(uri=uri), rosbag2_py.ConverterOptions('', ''))
    reader2.seek(stamps[20])
    print('after seek', sum(1 for _ in iter(lambda: reader2.read_next() if reader2.has_next() else None, None)))
    shutil.rmtree(folder)
    rclpy.shutdown()


main()
sys.stdout.flush()

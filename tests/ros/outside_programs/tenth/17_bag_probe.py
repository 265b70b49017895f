"""Write a bag with rosbag2_py from a node, close it, and read it back with a filter.

Meant: as in the tutorial "Recording a bag from a node (Python)": every message that was heard is in
the bag with its time; a filtered reader sees only its topic, seek works, metadata counts.
"""
import pathlib
import shutil
import tempfile

import rclpy
import rosbag2_py
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.utilities import get_message
from std_msgs.msg import Int64, String


class Recorder(Node):
    def __init__(self, uri):
        super().__init__('simple_bag_recorder')
        self.writer = rosbag2_py.SequentialWriter()
        self.writer.open(rosbag2_py.StorageOptions(uri=uri, storage_id='sqlite3'),
                         rosbag2_py.ConverterOptions('', ''))
        for number, (name, kind) in enumerate((('chatter', 'String'), ('count', 'Int64'))):
            self.writer.create_topic(rosbag2_py.TopicMetadata(
                id=number, name=name, type=f'std_msgs/msg/{kind}', serialization_format='cdr'))
        self.create_subscription(String, 'chatter', self.on_chatter, 10)
        self.talk = self.create_publisher(String, 'chatter', 10)
        self.said = self.heard = 0
        self.create_timer(0.1, self.tick)

    def on_chatter(self, message):
        self.heard += 1
        self.writer.write('chatter', serialize_message(message), self.get_clock().now().nanoseconds)

    def tick(self):
        if self.said < 20:
            self.talk.publish(String(data=f'line {self.said}'))
            if self.said % 5 == 0:
                self.writer.write('count', serialize_message(Int64(data=self.said)),
                                  self.get_clock().now().nanoseconds)
            self.said += 1


def read(uri, topics=None, since=None):
    reader = rosbag2_py.SequentialReader()
    reader.open(rosbag2_py.StorageOptions(uri=uri, storage_id='sqlite3'),
                rosbag2_py.ConverterOptions('cdr', 'cdr'))
    types = {t.name: t.type for t in reader.get_all_topics_and_types()}
    if topics:
        reader.set_filter(rosbag2_py.StorageFilter(topics=topics))
    if since:
        reader.seek(since)
    while reader.has_next():
        topic, data, stamp = reader.read_next()
        yield topic, deserialize_message(data, get_message(types[topic])), stamp


def main():
    folder = tempfile.mkdtemp()
    uri = folder + '/my_bag'
    rclpy.init()
    node = Recorder(uri)
    while node.heard < 20:
        rclpy.spin_once(node)
    node.writer.close()
    node.destroy_node()
    rclpy.shutdown()

    everything = list(read(uri))
    print('all', len(everything), 'in order', [s for *_, s in everything] == sorted(s for *_, s in everything))
    counts = [message.data for _, message, _ in read(uri, ['count'])]
    print('counts', counts)
    stamps = [stamp for topic, _, stamp in everything if topic == 'chatter']
    print('later', [m.data for _, m, _ in read(uri, ['chatter'], stamps[17])])
    print('gap', round((stamps[1] - stamps[0]) / 1e9, 2))
    metadata = rosbag2_py.Info().read_metadata(uri, 'sqlite3')
    print('metadata', metadata.message_count,
          sorted((t.topic_metadata.name, t.message_count) for t in metadata.topics_with_message_count))
    print('files', sorted(p.name for p in pathlib.Path(uri).iterdir()))
    shutil.rmtree(folder)


if __name__ == '__main__':
    main()

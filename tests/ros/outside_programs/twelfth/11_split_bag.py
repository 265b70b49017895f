"""A bag in several files: written with a limit of duration, its metadata read, read back in order, by regex, from a time on."""
import os
import tempfile

import rclpy
import rosbag2_py
from geometry_msgs.msg import Twist
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py.utilities import get_message
from std_msgs.msg import Int32, String

SECOND = 1_000_000_000


def topic(number, name, kind):
    return rosbag2_py.TopicMetadata(id=number, name=name, type=kind, serialization_format='cdr')


def open_reader(path, storage_id):
    reader = rosbag2_py.SequentialReader()
    reader.open(rosbag2_py.StorageOptions(uri=path, storage_id=storage_id),
                rosbag2_py.ConverterOptions(input_serialization_format='cdr', output_serialization_format='cdr'))
    return reader


def main():
    rclpy.init()
    folder = tempfile.mkdtemp()
    print('writers', {'mcap', 'sqlite3'} <= set(rosbag2_py.get_registered_writers()))
    for storage_id in ('mcap', 'sqlite3'):
        path = os.path.join(folder, f'split_{storage_id}')
        writer = rosbag2_py.SequentialWriter()
        writer.open(
            rosbag2_py.StorageOptions(uri=path, storage_id=storage_id, max_bagfile_duration=3,
                                      custom_data={'course': 'ROS 101'}),
            rosbag2_py.ConverterOptions('cdr', 'cdr'))
        writer.create_topic(topic(0, '/count', 'std_msgs/msg/Int32'))
        writer.create_topic(topic(1, '/robot/cmd', 'geometry_msgs/msg/Twist'))
        writer.create_topic(topic(2, '/robot/note', 'std_msgs/msg/String'))
        for number in range(100):
            stamp = SECOND * 50 + number * SECOND // 10
            writer.write('/count', serialize_message(Int32(data=number)), stamp)
            if number % 10 == 0:
                twist = Twist()
                twist.linear.x = number / 100
                writer.write('/robot/cmd', serialize_message(twist), stamp)
        writer.write('/robot/note', serialize_message(String(data='end')), SECOND * 60)
        writer.close()

        metadata = rosbag2_py.Info().read_metadata(path, storage_id)
        print(storage_id, 'messages', metadata.message_count, 'files', len(metadata.relative_file_paths) >= 3)
        print('custom', metadata.custom_data.get('course'))
        print(f'span {metadata.duration.total_seconds() if hasattr(metadata.duration, "total_seconds") else metadata.duration.nanoseconds / 1e9:.1f}')
        counts = {each.topic_metadata.name: each.message_count for each in metadata.topics_with_message_count}
        print('counts', sorted(counts.items()))

        reader = open_reader(path, storage_id)
        types = {each.name: each.type for each in reader.get_all_topics_and_types()}
        numbers, last = [], 0
        while reader.has_next():
            name, data, stamp = reader.read_next()
            assert stamp >= last
            last = stamp
            message = deserialize_message(data, get_message(types[name]))
            if name == '/count':
                numbers.append(message.data)
        print('in order', numbers == list(range(100)), last // SECOND)

        reader.seek(SECOND * 58)
        reader.set_filter(rosbag2_py.StorageFilter(topics=['/count']))
        rest = []
        while reader.has_next():
            rest.append(deserialize_message(reader.read_next()[1], Int32).data)
        print('from 58', rest[0], len(rest))

        reader = open_reader(path, storage_id)
        reader.set_filter(rosbag2_py.StorageFilter(regex='/robot/.*'))
        names = []
        while reader.has_next():
            names.append(reader.read_next()[0])
        print('by regex', names.count('/robot/cmd'), names.count('/robot/note'), len(names))
        reader.reset_filter()
        reader.set_read_order(rosbag2_py.ReadOrder(sort_by=rosbag2_py.ReadOrderSortBy.ReceivedTimestamp, reverse=False))
        reader.seek(0)
        print('again', reader.has_next(), reader.read_next()[0])
    rclpy.shutdown()


if __name__ == '__main__':
    main()

"""Counts for three seconds what every camera publishes, as found in the graph."""
import collections

import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image


def main():
    rclpy.init()
    node = Node('rate_check')
    end = node.get_clock().now() + rclpy.duration.Duration(seconds=0.5)
    while node.get_clock().now() < end:
        rclpy.spin_once(node, timeout_sec=0.1)
    seen = collections.Counter()
    frames = set()
    topics = sorted(n for n, types in node.get_topic_names_and_types() if 'sensor_msgs/msg/Image' in types)

    def heard(topic):
        def callback(msg):
            seen[topic] += 1
            frames.add((msg.header.frame_id, msg.width, len(msg.data), msg.data[5]))
        return callback

    subs = [node.create_subscription(Image, t, heard(t), qos_profile_sensor_data) for t in topics]
    end = node.get_clock().now() + rclpy.duration.Duration(seconds=3)
    while node.get_clock().now() < end:
        rclpy.spin_once(node, timeout_sec=0.1)
    for t in topics:
        node.get_logger().info(f'{t} {seen[t]}')
    node.get_logger().info(str(sorted(frames)))
    node.get_logger().info(' '.join(sorted(ns + '/' + n for n, ns in node.get_node_names_and_namespaces() if n == 'camera_node')))
    assert len(subs) == len(topics)
    node.destroy_node()
    rclpy.shutdown()

"""Publishes in a loop of its own, and never spins."""

from time import sleep

import rclpy
from std_msgs.msg import String


def main(args=None):
    with rclpy.init(args=args):
        node = rclpy.create_node("minimal_publisher")
        publisher = node.create_publisher(String, "topic", 10)
        msg = String()
        count = 0
        while rclpy.ok():
            msg.data = "Hello World: %d" % count
            count += 1
            node.get_logger().info('Publishing: "%s"' % msg.data)
            publisher.publish(msg)
            sleep(0.5)


if __name__ == "__main__":
    main()

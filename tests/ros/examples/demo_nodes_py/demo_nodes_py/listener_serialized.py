"""Listens to messages as bytes."""

import rclpy
from example_interfaces.msg import String
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.serialization import deserialize_message


class SerializedSubscriber(Node):
    def __init__(self):
        super().__init__("serialized_subscriber")
        self.subscription = self.create_subscription(
            String, "chatter", self.listener_callback, 10, raw=True
        )

    def listener_callback(self, msg):
        self.get_logger().info('I heard: "%s"' % msg)
        self.get_logger().info("which says: %s" % deserialize_message(msg, String).data)


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = SerializedSubscriber()
            rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()

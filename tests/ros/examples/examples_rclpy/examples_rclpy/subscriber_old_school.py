"""Subscribes by a function of the module, and spins once at a time."""

import rclpy
from std_msgs.msg import String

g_node = None


def chatter_callback(msg):
    g_node.get_logger().info('I heard: "%s"' % msg.data)


def main(args=None):
    global g_node
    rclpy.init(args=args)
    g_node = rclpy.create_node("minimal_subscriber")
    subscription = g_node.create_subscription(String, "topic", chatter_callback, 10)
    subscription  # against the warning of an unused variable
    while rclpy.ok():
        rclpy.spin_once(g_node)
    g_node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()

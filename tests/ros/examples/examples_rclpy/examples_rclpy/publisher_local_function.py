"""Publishes from a function within main, which a timer calls."""

import rclpy
from std_msgs.msg import String


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("minimal_publisher")
    publisher = node.create_publisher(String, "topic", 10)
    msg = String()
    count = 0

    def timer_callback():
        nonlocal count
        msg.data = f"Hello World: {count}"
        count += 1
        node.get_logger().info(f'Publishing: "{msg.data}"')
        publisher.publish(msg)

    timer = node.create_timer(0.5, timer_callback)
    rclpy.spin(node)
    node.destroy_timer(timer)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()

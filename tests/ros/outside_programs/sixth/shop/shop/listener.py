import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(String, "chatter", lambda m: self.get_logger().info(f"I heard: [{m.data}]"), 10)


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Listener())
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass

"""Says stop, for ``custom_executor``."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Estop(Node):
    def __init__(self):
        super().__init__("estop")
        self.pub = self.create_publisher(String, "estop", 10)
        self.create_timer(0.5, lambda: self.pub.publish(String(data="stop")))


def main(args=None):
    rclpy.init(args=args)
    node = Estop()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()

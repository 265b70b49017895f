"""Um nó que diz uma vez por segundo que está vivo."""

import rclpy
from rclpy.node import Node


class Heartbeat(Node):
    def __init__(self):
        # TODO: o nó deve chamar-se heartbeat
        super().__init__("nameless")
        # TODO: fazer com que self.beat seja chamado uma vez por segundo

    def beat(self):
        self.get_logger().info("alive")


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Heartbeat())


if __name__ == "__main__":
    main()

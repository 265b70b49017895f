"""The office says once how fast one may drive; the driver comes later
and drives that fast."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Float32


class Office(Node):
    def __init__(self):
        super().__init__("office")
        # TODO: kept for latecomers
        self.limit = self.create_publisher(Float32, "speed_limit", 10)
        self.limit.publish(Float32(data=self.declare_parameter("limit", 0.4).value))


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.speed = 0.0
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        # TODO: this hears nothing
        self.create_subscription(Float32, "speed_limit", self.on_limit, 10)
        self.create_timer(0.1, self.go)

    def on_limit(self, message):
        self.speed = message.data

    def go(self):
        command = Twist()
        command.linear.x = self.speed
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    executor = SingleThreadedExecutor()
    executor.add_node(Office())  # it has published before the next line
    executor.add_node(Driver())
    executor.spin()


if __name__ == "__main__":
    main()

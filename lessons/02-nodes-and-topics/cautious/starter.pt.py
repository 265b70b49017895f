"""Anda em frente, com cautela: 0.6 m/s; metade com uma parede a menos de
1.2 m; parado com uma a menos de 0.5 m."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Cautious(Node):
    def __init__(self):
        super().__init__("cautious")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)

    def on_scan(self, scan):
        """Chamada com cada mensagem do laser. scan.ranges[45] é a
        distância mesmo em frente, em metros."""
        command = Twist()
        # TODO: 0.6, 0.3 ou 0.0, conforme scan.ranges[45]
        command.linear.x = 0.0
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Cautious())


if __name__ == "__main__":
    main()

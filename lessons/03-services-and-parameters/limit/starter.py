"""Drives ahead, at a speed that others may set; and halts when it is
asked to."""

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from std_srvs.srv import Trigger


class Limited(Node):
    def __init__(self):
        super().__init__("limited")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go)
        # TODO: a parameter, limit, in m/s, 0.3 by default; negative ones
        # are refused
        # TODO: a service, halt, of the type Trigger

    def go(self):
        command = Twist()
        command.linear.x = 0.1  # TODO: the limit, as it is now
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Limited())


if __name__ == "__main__":
    main()

"""Drives ahead, at a speed that others may set; and halts when it is asked to."""

# Lesson: a service `halt`, a `std_srvs` `Trigger`, which answers with success

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
        self.declare_parameter("limit", 0.3)
        self.add_on_set_parameters_callback(self.on_parameters)
        self.halted = False
        self.create_subscription(Twist, "halt", self.on_halt, 10)

    def go(self):
        command = Twist()
        if not self.halted:
            command.linear.x = self.get_parameter("limit").value
        self.drive.publish(command)

    def on_parameters(self, parameters):
        """Asked before parameters change; whoever disagrees says so, and why."""
        fine = all(each.value >= 0 for each in parameters if each.name == "limit")
        return SetParametersResult(successful=fine, reason="" if fine else "a limit is 0 or more")

    def on_halt(self, request, response):
        self.halted = True
        response.success = True
        response.message = "standing still"
        return response


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Limited())


if __name__ == "__main__":
    main()

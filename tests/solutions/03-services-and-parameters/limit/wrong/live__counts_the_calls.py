# Lesson: the speed in m/s at which it drives ahead, also when the limit is changed while it drives
import math, rclpy, time
from geometry_msgs.msg import Twist
from rclpy.node import Node

from rcl_interfaces.msg import SetParametersResult
from std_srvs.srv import Trigger
class N(Node):
    def __init__(self):
        super().__init__("limited")
        self.p = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go)
        self.v = self.declare_parameter("limit", 0.3).value
        self.n = 0
        self.add_on_set_parameters_callback(self.on)
        self.create_service(Trigger, "halt", self.halt)
    def on(self, ps):
        self.n += 1
        return SetParametersResult(successful=self.n != 2)
    def halt(self, q, r):
        self.v = 0.0; r.success = True; return r
    def go(self):
        c = Twist(); c.linear.x = 0.4 if self.n and self.v else self.v; self.p.publish(c)

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(N())

if __name__ == "__main__":
    main()


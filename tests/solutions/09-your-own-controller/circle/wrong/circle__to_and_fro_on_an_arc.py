# Lesson: It works when the whole way lies within a tenth of that circle
import math, rclpy, time
from geometry_msgs.msg import Twist
from rclpy.node import Node

class N(Node):
    def __init__(self):
        super().__init__("circle")
        self.p = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go); self.n = 0
    def go(self):
        self.n += 1
        c = Twist(); s = 1 if self.n % 22 < 12 else -1; c.linear.x = 0.45*s; c.angular.z = 1.5*s; self.p.publish(c)

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(N())

if __name__ == "__main__":
    main()


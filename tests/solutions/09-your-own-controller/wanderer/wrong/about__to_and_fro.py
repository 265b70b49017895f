# Lesson: Write `on_scan` so that the robot wanders through rooms
import math, rclpy, time
from geometry_msgs.msg import Twist
from rclpy.node import Node

class N(Node):
    def __init__(self):
        super().__init__("w")
        self.p = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go); self.n = 0
    def go(self):
        self.n += 1
        c = Twist(); c.linear.x = 0.3 if self.n % 10 < 5 else -0.3; self.p.publish(c)

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(N())

if __name__ == "__main__":
    main()


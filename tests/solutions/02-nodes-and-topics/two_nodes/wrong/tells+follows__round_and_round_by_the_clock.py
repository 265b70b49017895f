# Lesson: turns on the spot, at 1.0 rad/s, while a wall is ahead
import math, rclpy, time
from geometry_msgs.msg import Twist
from rclpy.node import Node

from rclpy.executors import SingleThreadedExecutor
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool
class W(Node):
    def __init__(self):
        super().__init__("watcher")
        self.w = self.create_publisher(Bool, "wall_ahead", 10)
        self.create_subscription(LaserScan, "static_laser", self.on, 10)
    def on(self, s): self.w.publish(Bool(data=any(each < 0.5 for each in s.ranges[38:53])))
class D(Node):
    def __init__(self):
        super().__init__("driver")
        self.p = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Bool, "wall_ahead", lambda m: None, 10)
        self.create_timer(0.1, self.go)
    def go(self):
        c = Twist(); c.linear.x = 0.4; c.angular.z = 2.0
        self.p.publish(c)
def main(args=None):
    rclpy.init(args=args)
    e = SingleThreadedExecutor(); e.add_node(W()); e.add_node(D()); e.spin()
if __name__ == "__main__":
    main()

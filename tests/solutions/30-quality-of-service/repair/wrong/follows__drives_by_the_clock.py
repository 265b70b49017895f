# Lesson: `Scout` stands for the program of a sensor that you bought
import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool
class Scout(Node):
    def __init__(self):
        super().__init__("scout")
        self.warn = self.create_publisher(Bool, "wall_ahead", QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT))
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
    def on_scan(self, scan):
        self.warn.publish(Bool(data=bool([d for d in scan.ranges[38:53] if d < 0.5])))
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Bool, "wall_ahead", lambda m: None, 10)
        self.create_timer(0.1, self.go)
    def go(self):
        c = Twist(); c.linear.x = 0.4; c.angular.z = 2.0; self.drive.publish(c)
def main(args=None):
    rclpy.init(args=args)
    e = SingleThreadedExecutor(); e.add_node(Scout()); e.add_node(Driver()); e.spin()
if __name__ == "__main__":
    main()

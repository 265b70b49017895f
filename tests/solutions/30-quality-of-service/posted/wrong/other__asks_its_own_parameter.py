# Lesson: It is checked with a second limit too
import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Float32
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
class Office(Node):
    def __init__(self):
        super().__init__("office")
        self.limit = self.create_publisher(Float32, "speed_limit", LATCHED)
        self.limit.publish(Float32(data=self.declare_parameter("limit", 0.4).value))
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.speed = self.declare_parameter("limit", 0.4).value
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Float32, "speed_limit", lambda m: None, LATCHED)
        self.create_timer(0.1, self.go)
    def go(self):
        c = Twist(); c.linear.x = self.speed; self.drive.publish(c)
def main(args=None):
    rclpy.init(args=args)
    e = SingleThreadedExecutor(); e.add_node(Office()); e.add_node(Driver()); e.spin()
if __name__ == "__main__":
    main()

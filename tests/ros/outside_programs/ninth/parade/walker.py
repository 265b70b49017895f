import os

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Walker(Node):
    def __init__(self):
        super().__init__("walker", automatically_declare_parameters_from_overrides=True)
        self.pub = self.create_publisher(Twist, "velocity", 10)
        self.left = 20
        self.timer = self.create_timer(0.1, self.walk)
        self.get_logger().info(
            f"{self.get_namespace()} {self.pub.topic_name} speed {self.get_parameter('speed').value} "
            f"turn {self.get_parameter_or('turn').value} {os.environ['PARADE']}"
        )

    def walk(self):
        if self.left == 0:
            self.timer.cancel()
            return
        self.left -= 1
        twist = Twist()
        twist.linear.x = self.get_parameter("speed").value
        twist.angular.z = self.get_parameter("turn").value
        self.pub.publish(twist)


rclpy.init()
try:
    rclpy.spin(Walker())
except KeyboardInterrupt:
    print("stopped", flush=True)

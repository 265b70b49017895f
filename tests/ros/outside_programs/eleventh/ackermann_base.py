import math

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import Twist
from rclpy.node import Node


class AckermannToTwist(Node):
    def __init__(self):
        super().__init__('ackermann_to_twist', parameter_overrides=[])
        self.declare_parameters('', [('wheelbase', 0.33), ('max_steer', 0.4189)])
        self.pub = self.create_publisher(Twist, 'cmd_vel', 1)
        self.create_subscription(AckermannDriveStamped, 'drive', self.on_drive, 1)

    def on_drive(self, msg):
        limit = self.get_parameter('max_steer').value
        steer = max(-limit, min(limit, msg.drive.steering_angle))
        twist = Twist()
        twist.linear.x = msg.drive.speed
        twist.angular.z = msg.drive.speed * math.tan(steer) / self.get_parameter('wheelbase').value
        self.pub.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(AckermannToTwist())
    rclpy.shutdown()


main()

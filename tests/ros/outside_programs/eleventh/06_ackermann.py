import math

import numpy as np
import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

DESIRED = 2.0
LOOKAHEAD = 0.8


class WallFollow(Node):
    """The two beams of the lab, a at 50 degrees and b at 90 degrees to the left."""

    def __init__(self):
        super().__init__('wall_follow_node')
        self.kp, self.kd, self.ki = 0.8, 0.3, 0.0
        self.integral = 0.0
        self.prev_error = 0.0
        self.previous = None
        self.sub = self.create_subscription(LaserScan, '/scan', self.scan_callback, 10)
        self.pub = self.create_publisher(AckermannDriveStamped, '/drive', 10)

    def get_range(self, scan, angle):
        index = int(round((angle - scan.angle_min) / scan.angle_increment)) % len(scan.ranges)
        value = scan.ranges[index]
        return scan.range_max if math.isinf(value) or math.isnan(value) else value

    def scan_callback(self, scan):
        stamp = scan.header.stamp.sec + scan.header.stamp.nanosec * 1e-9
        theta = math.radians(40)
        b = self.get_range(scan, math.radians(90))
        a = self.get_range(scan, math.radians(90) - theta)
        alpha = math.atan2(a * math.cos(theta) - b, a * math.sin(theta))
        ahead = b * math.cos(alpha) + LOOKAHEAD * math.sin(alpha)
        error = ahead - DESIRED
        front = min(self.get_range(scan, math.radians(d)) for d in np.arange(-15, 16, 5))
        derivative = 0.0 if self.previous is None else (error - self.prev_error) / max(stamp - self.previous, 1e-3)
        self.previous, self.prev_error = stamp, error
        steer = float(np.clip(self.kp * error + self.kd * derivative, -0.15, 0.15))
        if front < DESIRED:
            steer = -0.4
        msg = AckermannDriveStamped()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = 'laser'
        msg.drive.steering_angle = steer
        msg.drive.steering_angle_velocity = 0.0
        msg.drive.speed = 0.6 if abs(steer) < math.radians(10) else 0.4
        self.pub.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    print('WallFollow Initialized')
    wall_follow_node = WallFollow()
    rclpy.spin(wall_follow_node)
    wall_follow_node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

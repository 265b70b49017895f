#!/usr/bin/env python3
import math
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from geometry_msgs.msg import Twist


class Stopper(Node):
    def __init__(self):
        super().__init__('stopper')
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.sub = self.create_subscription(LaserScan, 'scan', self.callback, qos_profile_sensor_data)
        self.stopped = False

    def callback(self, scan):
        # only the readings that are in front of the robot: |y| < width/2, x > 0
        width = 0.6
        shortest = math.inf
        for i, r in enumerate(scan.ranges):
            theta = scan.angle_min + i * scan.angle_increment
            if math.isinf(r) or math.isnan(r):
                continue
            x, y = r * math.cos(theta), r * math.sin(theta)
            if x > 0 and abs(y) < width / 2:
                shortest = min(shortest, x)

        t = Twist()
        if shortest < 1.0:
            t.linear.x = 0.0
            if not self.stopped:
                self.stopped = True
                self.get_logger().warning(f'Obstacle {shortest:.2f} m ahead - stopped')
        else:
            t.linear.x = 0.4
        self.pub.publish(t)


def main(args=None):
    rclpy.init(args=args)
    stopper = Stopper()
    rclpy.spin(stopper)
    rclpy.shutdown()


if __name__ == '__main__':
    main()

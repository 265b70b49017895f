#!/usr/bin/env python3
import math
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time, Duration
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan


class PotentialField(Node):
    def __init__(self, gx, gy):
        super().__init__('potential_field')
        self.g = (gx, gy)
        self.repulsion = Vector3()
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.scan_cb, qos_profile_sensor_data)
        self.create_subscription(Odometry, 'odom', self.odom_cb, 10)
        self.reached = False
        self.t0 = self.get_clock().now()

    def scan_cb(self, scan):
        # repulsive force in robot coordinates, from everything nearer than 1 m
        fx = fy = 0.0
        n = len(scan.ranges)
        for i in range(n):
            r = scan.ranges[i]
            if scan.range_min < r < 1.0:
                a = scan.angle_min + i * scan.angle_increment
                mag = (1.0 / r - 1.0) / r ** 2 / n
                fx -= mag * math.cos(a)
                fy -= mag * math.sin(a)
        self.repulsion = Vector3(x=fx, y=fy, z=0.0)

    def odom_cb(self, odom):
        p, q = odom.pose.pose.position, odom.pose.pose.orientation
        yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
        dx, dy = self.g[0] - p.x, self.g[1] - p.y
        d = math.hypot(dx, dy)
        cmd = Twist()
        if d < 0.15:
            self.reached = True
        if self.reached:
            took: Duration = self.get_clock().now() - self.t0
            self.get_logger().info('Goal in %.0f s' % (took.nanoseconds / 1e9), once=True)
        else:
            # attraction, limited to 1
            ax, ay = dx / max(d, 1.0), dy / max(d, 1.0)
            bx = math.cos(yaw) * ax + math.sin(yaw) * ay + 2.0 * self.repulsion.x
            by = -math.sin(yaw) * ax + math.cos(yaw) * ay + 2.0 * self.repulsion.y
            heading = math.atan2(by, bx)
            cmd.angular.z = max(-0.8, min(0.8, 1.5 * heading))
            cmd.linear.x = 0.4 * min(1.0, math.hypot(bx, by)) * max(0.0, math.cos(heading))
        self.pub.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(PotentialField(-3.2, 3.0))


if __name__ == '__main__':
    main()

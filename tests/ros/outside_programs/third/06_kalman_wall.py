#!/usr/bin/env python3
"""One-dimensional Kalman filter: the distance to the wall ahead from odometry (predict) and noisy laser (update)."""
import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan


class KalmanWall(Node):
    def __init__(self):
        super().__init__('kalman_wall')
        self.rng = np.random.default_rng(7)
        self.R = self.declare_parameter('measurement_variance', 0.09).value
        self.Q = self.declare_parameter('process_variance', 1e-4).value
        self.x, self.P = None, 1.0
        self.last_odom_x = None
        self.raw_errors, self.errors = [], []
        self.create_subscription(LaserScan, 'scan', self.update, qos_profile_sensor_data)
        self.create_subscription(Odometry, 'odom', self.predict, qos_profile_sensor_data)
        self.est_pub = self.create_publisher(PoseWithCovarianceStamped, 'wall_estimate', 10)
        self.cmd_pub = self.create_publisher(Twist, 'cmd_vel', 10)

    def predict(self, odom):
        x = odom.pose.pose.position.x
        if self.last_odom_x is not None and self.x is not None:
            u = x - self.last_odom_x
            self.x -= u
            self.P += self.Q
        self.last_odom_x = x

    def update(self, scan):
        true = float(np.asarray(scan.ranges)[0])
        z = true + self.rng.normal(0.0, np.sqrt(self.R))
        if self.x is None:
            self.x = z
            return
        K = self.P / (self.P + self.R)
        self.x += K * (z - self.x)
        self.P *= 1.0 - K
        self.raw_errors.append(z - true)
        self.errors.append(self.x - true)

        est = PoseWithCovarianceStamped()
        est.header.stamp = scan.header.stamp
        est.header.frame_id = scan.header.frame_id
        est.pose.pose.position.x = self.x
        est.pose.covariance[0] = self.P
        self.est_pub.publish(est)

        cmd = Twist()
        cmd.linear.x = float(np.clip(self.x - 2.0, 0.0, 0.3))
        self.cmd_pub.publish(cmd)
        if len(self.errors) == 200:
            raw = np.sqrt(np.mean(np.square(self.raw_errors[50:])))
            filtered = np.sqrt(np.mean(np.square(self.errors[50:])))
            self.get_logger().info(f'rmse raw {raw:.3f} filtered {filtered:.3f}')
            print('filter helps' if filtered < raw / 3 else 'filter is useless')
            raise SystemExit


def main(args=None):
    rclpy.init(args=args)
    node = KalmanWall()
    try:
        rclpy.spin(node)
    except SystemExit:
        node.cmd_pub.publish(Twist())
        rclpy.logging.get_logger('Quitting').info('Done')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

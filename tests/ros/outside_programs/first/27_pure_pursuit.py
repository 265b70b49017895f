#!/usr/bin/env python3
import numpy as np
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist, PoseStamped
from nav_msgs.msg import Odometry, Path

LOOKAHEAD = 0.5
SPEED = 0.35


class PurePursuit(Node):
    def __init__(self):
        super().__init__('pure_pursuit')
        # an S: two quarter arcs of radius 1.5 m
        a = np.linspace(0, np.pi / 2, 30)
        first = np.stack([1.5 * np.sin(a), 1.5 - 1.5 * np.cos(a)], axis=1)
        second = np.stack([3.0 - 1.5 * np.cos(a), 1.5 + 1.5 * np.sin(a)], axis=1)
        self.path = np.concatenate([first, second[1:]])
        self.last = 0
        self.done = False

        self.path_pub = self.create_publisher(Path, 'reference_path', 1)
        self.cmd_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.control, 10)
        self.create_timer(1.0, self.publish_path)

    def publish_path(self):
        msg = Path()
        msg.header.frame_id = 'odom'
        msg.header.stamp = self.get_clock().now().to_msg()
        for x, y in self.path:
            ps = PoseStamped()
            ps.header = msg.header
            ps.pose.position.x = float(x)
            ps.pose.position.y = float(y)
            ps.pose.orientation.w = 1.0
            msg.poses.append(ps)
        self.path_pub.publish(msg)

    def control(self, odom):
        p = odom.pose.pose.position
        q = odom.pose.pose.orientation
        yaw = np.arctan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2))
        pos = np.array([p.x, p.y])
        twist = Twist()
        if np.linalg.norm(self.path[-1] - pos) < 0.15 or self.done:
            if not self.done:
                self.get_logger().info('end of path')
            self.done = True
            self.cmd_pub.publish(twist)
            return
        # first point beyond the lookahead distance, never going back along the path
        d = np.linalg.norm(self.path - pos, axis=1)
        i = self.last
        while i < len(self.path) - 1 and d[i] < LOOKAHEAD:
            i += 1
        self.last = i
        c, s = np.cos(yaw), np.sin(yaw)
        local = np.array([[c, s], [-s, c]]) @ (self.path[i] - pos)
        L2 = float(local @ local)
        curvature = 2.0 * local[1] / max(L2, 1e-3)
        twist.linear.x = SPEED
        twist.angular.z = float(np.clip(SPEED * curvature, -1.0, 1.0))
        self.cmd_pub.publish(twist)


def main(args=None):
    rclpy.init(args=args)
    node = PurePursuit()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

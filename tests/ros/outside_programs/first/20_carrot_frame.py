#!/usr/bin/env python3
import math
import sys

from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
import tf2_ros


class CarrotChaser(Node):
    """Broadcasts a frame 'carrot' fixed in odom and drives the base onto it."""

    def __init__(self, x, y):
        super().__init__('carrot_chaser')
        self.x, self.y = x, y
        self.br = tf2_ros.TransformBroadcaster(self)
        self.buf = tf2_ros.Buffer()
        self.lis = tf2_ros.TransformListener(self.buf, self)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.broadcast, 10)
        self.create_timer(0.1, self.chase)

    def broadcast(self, odom):
        t = TransformStamped()
        t.header.stamp = odom.header.stamp
        t.header.frame_id = 'odom'
        t.child_frame_id = 'carrot'
        t.transform.translation.x = self.x
        t.transform.translation.y = self.y
        t.transform.rotation.w = 1.0
        self.br.sendTransform(t)

    def chase(self):
        try:
            tf = self.buf.lookup_transform('base_link', 'carrot', rclpy.time.Time())
        except (tf2_ros.LookupException, tf2_ros.ConnectivityException, tf2_ros.ExtrapolationException):
            self.get_logger().warn('no transform yet', throttle_duration_sec=2.0)
            return
        p = tf.transform.translation
        dist = math.sqrt(p.x ** 2 + p.y ** 2)
        msg = Twist()
        if dist > 0.2:
            msg.angular.z = max(-0.9, min(0.9, 1.2 * math.atan2(p.y, p.x)))
            msg.linear.x = min(0.35, 0.5 * dist)
        else:
            self.get_logger().info('caught the carrot', once=True)
        self.pub.publish(msg)


def main():
    rclpy.init(args=sys.argv)
    node = CarrotChaser(2.0, -1.0)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()

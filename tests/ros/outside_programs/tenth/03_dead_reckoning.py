"""Integrate the commands to an odometry of one's own, broadcast it, and compare with /odom.

Meant: the robot drives two arcs; the integrated pose agrees with the robot's odometry to 5 cm,
and the transform my_odom -> my_base can be looked up by the same process.
"""
import math

import rclpy
from geometry_msgs.msg import Quaternion, TransformStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import TransformBroadcaster
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener


def quaternion(yaw):
    return Quaternion(x=0.0, y=0.0, z=math.sin(yaw / 2), w=math.cos(yaw / 2))


def yaw_of(q):
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2))


class Reckoner(Node):
    def __init__(self):
        super().__init__('reckoner')
        self.x = self.y = self.yaw = 0.0
        self.v = self.w = 0.0
        self.first = None
        self.odom = None
        self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
        self.out = self.create_publisher(Odometry, 'my_odom', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.broadcaster = TransformBroadcaster(self)
        self.buffer = Buffer(cache_time=Duration(seconds=30.0))
        self.listener = TransformListener(self.buffer, self)
        self.stamp = self.get_clock().now()
        self.begin = self.stamp
        self.create_timer(0.02, self.integrate)
        self.create_timer(0.1, self.drive)
        self.told = False

    def on_odom(self, odom):
        self.odom = odom
        if self.first is None:
            self.first = odom

    def drive(self):
        t = (self.get_clock().now() - self.begin).nanoseconds / 1e9
        twist = Twist()
        if t < 3.0:
            twist.linear.x, twist.angular.z = 0.15, 0.3
        elif t < 6.0:
            twist.linear.x, twist.angular.z = 0.15, -0.3
        elif t > 7.0 and not self.told:
            self.told = True
            self.compare()
        self.commands.publish(twist)
        self.v, self.w = twist.linear.x, twist.angular.z

    def integrate(self):
        now = self.get_clock().now()
        dt = (now - self.stamp).nanoseconds / 1e9
        self.stamp = now
        self.x += self.v * math.cos(self.yaw + self.w * dt / 2) * dt
        self.y += self.v * math.sin(self.yaw + self.w * dt / 2) * dt
        self.yaw += self.w * dt
        odom = Odometry()
        odom.header.stamp = now.to_msg()
        odom.header.frame_id = 'my_odom'
        odom.child_frame_id = 'my_base'
        odom.pose.pose.position.x = self.x
        odom.pose.pose.position.y = self.y
        odom.pose.pose.orientation = quaternion(self.yaw)
        odom.twist.twist.linear.x = self.v
        odom.twist.twist.angular.z = self.w
        odom.pose.covariance[0] = 0.01
        odom.pose.covariance[35] = 0.02
        self.out.publish(odom)
        transform = TransformStamped(header=odom.header, child_frame_id='my_base')
        transform.transform.translation.x = self.x
        transform.transform.translation.y = self.y
        transform.transform.rotation = odom.pose.pose.orientation
        self.broadcaster.sendTransform(transform)

    def compare(self):
        a, b = self.first.pose.pose, self.odom.pose.pose
        heading = yaw_of(a.orientation)
        dx, dy = b.position.x - a.position.x, b.position.y - a.position.y
        x = math.cos(heading) * dx + math.sin(heading) * dy
        y = -math.sin(heading) * dx + math.cos(heading) * dy
        error = math.hypot(x - self.x, y - self.y)
        self.get_logger().info(f'moved: {math.hypot(x, y) > 0.5}, agrees: {error < 0.05}')
        found = self.buffer.lookup_transform('my_odom', 'my_base', Time())
        same = abs(found.transform.translation.x - self.x) < 0.01
        self.get_logger().info(f'transform agrees: {same}')
        self.get_logger().info(f'can transform: {self.buffer.can_transform("my_base", "my_odom", Time())}')


rclpy.init()
rclpy.spin(Reckoner())

#!/usr/bin/env python3
"""tf2 tutorial "Traveling in time": where was the robot one second ago, seen from now?"""
import math

import rclpy
from geometry_msgs.msg import TransformStamped, Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster
from tf2_ros import ConnectivityException, ExtrapolationException, LookupException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener


class Beacon(Node):
    def __init__(self):
        super().__init__('beacon')
        self.static = StaticTransformBroadcaster(self)
        mount = TransformStamped()
        mount.header.stamp = self.get_clock().now().to_msg()
        mount.header.frame_id, mount.child_frame_id = 'base_link', 'camera'
        mount.transform.translation.x, mount.transform.rotation.w = 0.1, 1.0
        self.static.sendTransform(mount)
        self.dynamic = TransformBroadcaster(self)
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.n = 0
        self.errors = []
        self.timer = self.create_timer(0.1, self.tick)

    def tick(self):
        self.n += 1
        cmd = Twist()
        cmd.linear.x = 0.4
        self.pub.publish(cmd)
        now = self.get_clock().now()
        carrot = TransformStamped()
        carrot.header.stamp = now.to_msg()
        carrot.header.frame_id, carrot.child_frame_id = 'odom', 'carrot'
        carrot.transform.translation.y = 1.0
        carrot.transform.rotation.z, carrot.transform.rotation.w = math.sin(math.pi / 4), math.cos(math.pi / 4)
        self.dynamic.sendTransform(carrot)
        if self.n < 25:
            return
        past = now - Duration(seconds=1.2)
        recent = now - Duration(seconds=0.2)
        try:
            back = self.buffer.lookup_transform_full('base_link', recent, 'base_link', past, 'odom',
                                                     timeout=Duration(seconds=0.05))
        except (LookupException, ConnectivityException, ExtrapolationException) as error:
            self.get_logger().warning(f'{error}')
            return
        self.errors.append(back.transform.translation.x)
        if self.n == 40:
            camera = self.buffer.lookup_transform('odom', 'camera', Time())
            base = self.buffer.lookup_transform('odom', 'base_link', Time())
            print(f'camera {camera.transform.translation.x - base.transform.translation.x:.2f} ahead')
            seen = self.buffer.lookup_transform('carrot', 'odom', Time()).transform.translation
            print(f'odom seen from the carrot at {seen.x:.1f} {abs(seen.y):.1f}')
            try:
                self.buffer.lookup_transform('odom', 'base_link', now + Duration(seconds=5))
            except ExtrapolationException:
                print('no look into the future')
            try:
                self.buffer.lookup_transform('odom', 'spoon', Time())
            except LookupException:
                print('there is no spoon')
            print(f'a second ago {min(self.errors):.1f} {max(self.errors):.1f}', flush=True)
            self.pub.publish(Twist())
            self.timer.cancel()
            raise KeyboardInterrupt


def main():
    rclpy.init()
    node = Beacon()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    rclpy.shutdown()


main()

#!/usr/bin/env python3
"""sun -> earth (one turn in 8 s, 3 m) -> moon (one turn in 2 s, 1 m), and a static frame flag on the moon"""
import math
import numpy as np

import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from geometry_msgs.msg import TransformStamped
from tf2_ros import (Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener,
                     LookupException, ConnectivityException, ExtrapolationException)


def make(parent, child, x, y, yaw, stamp):
    t = TransformStamped()
    t.header.stamp = stamp
    t.header.frame_id = parent
    t.child_frame_id = child
    t.transform.translation.x = x
    t.transform.translation.y = y
    t.transform.rotation.z = math.sin(yaw / 2)
    t.transform.rotation.w = math.cos(yaw / 2)
    return t


class Planets(Node):
    def __init__(self):
        super().__init__('planets')
        self.broadcaster = TransformBroadcaster(self)
        self.static = StaticTransformBroadcaster(self)
        self.static.sendTransform(make('moon', 'flag', 0.5, 0.0, 0.0, self.get_clock().now().to_msg()))
        self.buffer = Buffer(cache_time=Duration(seconds=20))
        self.listener = TransformListener(self.buffer, self)
        self.begin = self.get_clock().now()
        self.create_timer(0.02, self.turn)
        self.create_timer(0.5, self.measure)
        self.distances = []

    def turn(self):
        now = self.get_clock().now()
        t = (now - self.begin).nanoseconds / 1e9
        a, b = 2 * math.pi * t / 8, 2 * math.pi * t / 2
        self.broadcaster.sendTransform([
            make('sun', 'earth', 3 * math.cos(a), 3 * math.sin(a), 0.0, now.to_msg()),
            make('earth', 'moon', math.cos(b), math.sin(b), b, now.to_msg())])

    def measure(self):
        try:
            past = self.get_clock().now() - Duration(seconds=0.2)
            tr = self.buffer.lookup_transform('sun', 'flag', past, timeout=Duration(seconds=0.0))
        except (LookupException, ConnectivityException, ExtrapolationException) as e:
            self.get_logger().warn(type(e).__name__)
            return
        v = np.array([tr.transform.translation.x, tr.transform.translation.y])
        self.distances.append(float(np.linalg.norm(v)))
        if len(self.distances) == 16:
            lo, hi = min(self.distances), max(self.distances)
            verdict = 'plausible' if 1.4 < lo and hi < 4.6 and hi - lo > 1.0 else 'wrong'
            self.get_logger().info(f'flag between {lo:.1f} and {hi:.1f} m from the sun: {verdict}')
            self.get_logger().info('moon can see the sun: %s' % self.buffer.can_transform('moon', 'sun', rclpy.time.Time()))


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Planets())


if __name__ == '__main__':
    main()

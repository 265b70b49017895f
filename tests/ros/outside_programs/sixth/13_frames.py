"""tf2: static and moving frames, lookups at a time, can_transform, a point carried over, errors by their names."""
import math
import rclpy
from geometry_msgs.msg import PointStamped, TransformStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
import tf2_geometry_msgs
from tf2_ros import (Buffer, ConnectivityException, ExtrapolationException, LookupException, StaticTransformBroadcaster,
                     TransformBroadcaster, TransformListener)


class N(Node):
    def __init__(self):
        super().__init__("frames")
        self.static = StaticTransformBroadcaster(self)
        self.moving = TransformBroadcaster(self)
        self.buf = Buffer(cache_time=Duration(seconds=5))
        self.lis = TransformListener(self.buf, self, spin_thread=False)
        s = TransformStamped()
        s.header.stamp = self.get_clock().now().to_msg()
        s.header.frame_id, s.child_frame_id = "base", "laser"
        s.transform.translation.x = 0.2
        s.transform.rotation.w = 1.0
        self.static.sendTransform(s)
        self.t0 = self.get_clock().now()
        self.n = 0
        self.create_timer(0.1, self.tick)

    def tick(self):
        now = self.get_clock().now()
        a = (now - self.t0).nanoseconds * 1e-9
        t = TransformStamped()
        t.header.stamp = now.to_msg()
        t.header.frame_id, t.child_frame_id = "odom2", "base"
        t.transform.translation.x = a
        t.transform.rotation.z, t.transform.rotation.w = math.sin(a / 2), math.cos(a / 2)
        self.moving.sendTransform(t)
        self.n += 1
        if self.n == 20:
            past = self.buf.lookup_transform("odom2", "base", now - Duration(seconds=1.0))
            print("past %.2f" % (a - past.transform.translation.x))
            p = PointStamped()
            p.header.frame_id = "laser"
            p.header.stamp = Time().to_msg()
            p.point.x = 1.0
            q = self.buf.transform(p, "base")
            print("point %.2f in %s" % (q.point.x, q.header.frame_id))
            print(self.buf.can_transform("odom2", "laser", Time()), self.buf.can_transform("odom2", "moon", Time()))
            for target, when in (("moon", Time()), ("odom2", now + Duration(seconds=10))):
                try:
                    self.buf.lookup_transform(target, "laser", when)
                except (LookupException, ConnectivityException, ExtrapolationException) as e:
                    print(type(e).__name__)
            rclpy.shutdown()


rclpy.init()
n = N()
try:
    rclpy.spin(n)
except rclpy.executors.ExternalShutdownException:
    pass

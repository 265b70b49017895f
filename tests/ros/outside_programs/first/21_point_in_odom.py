#!/usr/bin/env python3
"""
A lidar frame is mounted 20 cm ahead of base_link (static transform). The nearest point of a made-up
detection, 1 m in front of that lidar, is transformed into odom while the robot turns on the spot.
"""
import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import PointStamped, TransformStamped, Twist
from tf2_ros import Buffer, TransformListener, StaticTransformBroadcaster, TransformException
import tf2_geometry_msgs  # noqa: F401  (registers the PointStamped conversions)


class PointInOdom(Node):
    def __init__(self):
        super().__init__('point_in_odom')
        self.static = StaticTransformBroadcaster(self)
        st = TransformStamped()
        st.header.stamp = self.get_clock().now().to_msg()
        st.header.frame_id = 'base_link'
        st.child_frame_id = 'my_lidar'
        st.transform.translation.x = 0.2
        st.transform.rotation.w = 1.0
        self.static.sendTransform(st)

        self.tf_buffer = Buffer()
        self.tf_listener = TransformListener(self.tf_buffer, self)
        self.pub = self.create_publisher(PointStamped, 'detection_odom', 10)
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_timer(0.2, self.run)
        self.half = False

    def run(self):
        self.cmd.publish(Twist()) if self.half else self.cmd.publish(self.turn())
        p = PointStamped()
        p.header.frame_id = 'my_lidar'       # stamp zero: the latest
        p.point.x = 1.0
        try:
            q = self.tf_buffer.transform(p, 'odom')
        except TransformException as e:
            self.get_logger().warning(str(e))
            return
        self.pub.publish(q)
        angle = math.atan2(q.point.y, q.point.x)
        if angle > math.pi / 2 and not self.half:
            self.half = True
            r = math.hypot(q.point.x, q.point.y)
            self.get_logger().info('the point is on the left now, %.1f m away' % r)

    @staticmethod
    def turn():
        t = Twist()
        t.angular.z = 0.4
        return t


if __name__ == '__main__':
    rclpy.init()
    n = PointInOdom()
    rclpy.spin(n)

"""A camera on a pan joint on a robot: points, poses and vectors go from frame to frame, also through a fixed frame and the past."""
import math

import rclpy
import tf2_geometry_msgs  # registers the types
from geometry_msgs.msg import PointStamped, PoseStamped, Quaternion, TransformStamped, Vector3Stamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import (
    Buffer,
    ConnectivityException,
    ExtrapolationException,
    LookupException,
    StaticTransformBroadcaster,
    TransformBroadcaster,
    TransformException,
    TransformListener,
)
from tf2_ros.buffer_interface import TypeException


def about_z(angle):
    return Quaternion(x=0.0, y=0.0, z=math.sin(angle / 2), w=math.cos(angle / 2))


class Robot(Node):
    """Drives along x at 0.5 m/s and pans its camera by 0.2 rad/s."""

    def __init__(self):
        super().__init__('robot')
        self.moving = TransformBroadcaster(self)
        self.fixed = StaticTransformBroadcaster(self)
        self.fixed.sendTransform([
            self.transform('base_link', 'mast', 0.1, 0.0, 0.4, 0.0),
            self.transform('head', 'camera', 0.05, 0.0, 0.0, 0.0),
            self.transform('island', 'palm', 1.0, 0.0, 0.0, 0.0),
        ])
        self.begun = self.get_clock().now()
        self.create_timer(0.05, self.tick)

    def transform(self, parent, child, x, y, z, yaw):
        message = TransformStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id, message.child_frame_id = parent, child
        message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = x, y, z
        message.transform.rotation = about_z(yaw)
        return message

    def tick(self):
        t = (self.get_clock().now() - self.begun).nanoseconds / 1e9
        self.moving.sendTransform(self.transform('odom', 'base_link', 0.5 * t, 0.0, 0.0, 0.0))
        self.moving.sendTransform(self.transform('mast', 'head', 0.0, 0.0, 0.1, math.pi / 2))


class Viewer(Node):
    def __init__(self):
        super().__init__('viewer')
        self.buffer = Buffer(cache_time=Duration(seconds=5.0), node=self)
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(3.0, self.look)
        self.done = False

    def attempt(self, target, source, when=Time(), timeout=Duration()):
        try:
            self.buffer.lookup_transform(target, source, when, timeout)
            return 'found'
        except (LookupException, ConnectivityException, ExtrapolationException) as problem:
            return type(problem).__name__

    def look(self):
        if self.done:
            return
        point = PointStamped()
        point.header.frame_id = 'camera'
        point.point.x = 1.0
        in_base = self.buffer.transform(point, 'base_link')
        print(f'point {in_base.point.x:.2f} {in_base.point.y:.2f} {in_base.point.z:.2f} in {in_base.header.frame_id}')
        vector = Vector3Stamped()
        vector.header.frame_id = 'camera'
        vector.vector.x = 1.0
        found = tf2_geometry_msgs.do_transform_vector3(vector, self.buffer.lookup_transform('base_link', 'camera', Time()))
        print(f'vector {found.vector.x:.2f} {found.vector.y:.2f}')
        pose = PoseStamped()
        pose.header.frame_id = 'camera'
        pose.pose.position.x = 1.0
        pose.pose.orientation.w = 1.0
        moved = self.buffer.transform(pose, 'mast', timeout=Duration(seconds=0.1))
        print(f'pose {moved.pose.position.y:.2f} {moved.pose.orientation.z:.3f} {moved.pose.orientation.w:.3f}')
        now = self.get_clock().now() - Duration(seconds=0.2)
        before = now - Duration(seconds=1)
        travelled = self.buffer.lookup_transform_full('base_link', now, 'base_link', before, 'odom', Duration(seconds=0.5))
        print(f'a second ago {travelled.transform.translation.x:.2f}')
        print('errors', self.attempt('odom', 'nowhere'), self.attempt('odom', 'palm'),
              self.attempt('odom', 'base_link', self.get_clock().now() + Duration(seconds=9)),
              self.attempt('odom', 'base_link', Time(nanoseconds=1)))
        print('can', self.buffer.can_transform('odom', 'camera', Time()), self.buffer.can_transform('odom', 'palm', Time()))
        try:
            self.buffer.transform('a string', 'odom')
        except (TypeException, AttributeError, TransformException) as problem:
            print('no', type(problem).__name__)
        print('frames', 'palm' in self.buffer.all_frames_as_string(), self.buffer.all_frames_as_yaml().count('parent'))
        self.done = True


def main():
    rclpy.init()
    robot, viewer = Robot(), Viewer()
    executor = rclpy.executors.SingleThreadedExecutor()
    for node in (robot, viewer):
        executor.add_node(node)
    while not viewer.done:
        executor.spin_once()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

"""Static frames of a robot's sensors, looked up with and without patience."""

import math

import rclpy
import tf2_geometry_msgs  # noqa: F401 - makes stamped points known to tf2
from geometry_msgs.msg import PointStamped, TransformStamped
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


def make(parent, child, stamp, x, y, yaw):
    transform = TransformStamped()
    transform.header.stamp = stamp
    transform.header.frame_id = parent
    transform.child_frame_id = child
    transform.transform.translation.x = x
    transform.transform.translation.y = y
    transform.transform.rotation.z = math.sin(yaw / 2)
    transform.transform.rotation.w = math.cos(yaw / 2)
    return transform


class Frames(Node):
    def __init__(self):
        super().__init__("frames")
        self.fixed = StaticTransformBroadcaster(self)
        now = self.get_clock().now().to_msg()
        self.fixed.sendTransform(
            [
                make("base_link", "laser", now, 0.2, 0.0, 0.0),
                make("base_link", "camera", now, 0.0, 0.5, math.pi / 2),
                make("elsewhere", "island", now, 1.0, 0.0, 0.0),
            ]
        )
        self.moving = TransformBroadcaster(self)
        self.buffer = Buffer(cache_time=Duration(seconds=5.0))
        self.listener = TransformListener(self.buffer, self)
        self.start = self.get_clock().now()
        self.create_timer(0.05, self.move)
        self.steps = iter([self.early, self.patient, self.past, self.points, self.finish])
        self.timer = self.create_timer(0.5, self.next_step)

    def age(self):
        return (self.get_clock().now() - self.start).nanoseconds / 1e9

    def move(self):
        if self.age() < 0.7:
            return
        now = self.get_clock().now().to_msg()
        self.moving.sendTransform(make("odom", "base_link", now, self.age(), 0.0, 0.0))

    def next_step(self):
        next(self.steps)()

    def early(self):
        mount = self.buffer.lookup_transform("camera", "laser", Time())
        at = mount.transform.translation
        self.get_logger().info(f"laser in camera {at.x:.2f} {at.y:.2f} yaw {mount.transform.rotation.z:.3f}")
        for target, source in (("odom", "laser"), ("island", "laser"), ("nothing", "laser")):
            try:
                self.buffer.lookup_transform(target, source, Time())
            except LookupException:
                self.get_logger().info(f"{target}: no such frame")
            except ConnectivityException:
                self.get_logger().info(f"{target}: not connected")
        self.get_logger().info(f"can: {self.buffer.can_transform('odom', 'laser', Time())}")
        self.waiting = self.buffer.wait_for_transform_async("odom", "laser", Time())
        self.waiting.add_done_callback(lambda future: self.get_logger().info(f"came at {self.age():.1f}"))

    def patient(self):
        self.get_logger().info(f"waited for: {self.waiting.done()}")
        found = self.buffer.lookup_transform("odom", "laser", Time(), timeout=Duration(seconds=0.2))
        self.get_logger().info(f"laser at {found.transform.translation.x:.1f}")
        try:
            later = self.get_clock().now() + Duration(seconds=10.0)
            self.buffer.lookup_transform("odom", "laser", later)
        except ExtrapolationException:
            self.get_logger().info("the future is not known")

    def past(self):
        then = self.get_clock().now() - Duration(seconds=0.5)
        found = self.buffer.lookup_transform("odom", "base_link", then)
        self.get_logger().info(f"half a second ago at {found.transform.translation.x:.1f}")
        moved = self.buffer.lookup_transform_full(
            "base_link", self.get_clock().now() - Duration(seconds=0.1), "base_link", then, "odom"
        )
        self.get_logger().info(f"moved {-moved.transform.translation.x:.1f}")

    def points(self):
        point = PointStamped()
        point.header.frame_id = "camera"
        point.point.x = 2.0
        try:
            inside = self.buffer.transform(point, "base_link")
            self.get_logger().info(f"seen at {inside.point.x:.2f} {inside.point.y:.2f} in {inside.header.frame_id}")
        except TransformException as error:
            self.get_logger().error(str(error))

    def finish(self):
        self.get_logger().info(f"frames: {'base_link' in self.buffer.all_frames_as_yaml()}")
        raise SystemExit


def main():
    rclpy.init()
    try:
        rclpy.spin(Frames())
    except SystemExit:
        pass


if __name__ == "__main__":
    main()

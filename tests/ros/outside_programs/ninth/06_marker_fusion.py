"""Detections of a camera and of a beacon are matched in time and brought into the map, which comes late."""

import math
from functools import partial

import rclpy
import tf2_geometry_msgs  # noqa: F401  (registers the conversions)
from geometry_msgs.msg import PointStamped, PoseStamped, TransformStamped
from message_filters import ApproximateTimeSynchronizer, Cache, Subscriber
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import (
    Buffer,
    ConnectivityException,
    ExtrapolationException,
    LookupException,
    StaticTransformBroadcaster,
    TransformBroadcaster,
    TransformListener,
)


class Robot(Node):
    """Publishes what a robot would: a turning base, a camera on it, and two sensors out of step."""

    def __init__(self):
        super().__init__("robot")
        self.broadcaster = TransformBroadcaster(self)
        self.static = StaticTransformBroadcaster(self)
        self.static.sendTransform([self.transform("base_link", "camera", 0.2, 0.0, math.pi / 2)])
        self.points = self.create_publisher(PointStamped, "camera/point", 10)
        self.poses = self.create_publisher(PoseStamped, "beacon/pose", 10)
        self.start = self.get_clock().now()
        self.create_timer(0.02, self.move)
        self.create_timer(0.10, self.see)
        self.create_timer(0.25, self.hear)

    def transform(self, parent, child, x, y, yaw):
        t = TransformStamped()
        t.header.stamp = self.get_clock().now().to_msg()
        t.header.frame_id, t.child_frame_id = parent, child
        t.transform.translation.x, t.transform.translation.y = x, y
        t.transform.rotation.z, t.transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        return t

    def elapsed(self):
        return (self.get_clock().now() - self.start).nanoseconds / 1e9

    def move(self):
        t = self.elapsed()
        if t < 1.0:
            return
        self.broadcaster.sendTransform(self.transform("map", "base_link", 0.5 * t, 0.0, 0.0))

    def see(self):
        point = PointStamped()
        point.header.frame_id = "camera"
        point.header.stamp = self.get_clock().now().to_msg()
        point.point.x = 1.0
        self.points.publish(point)

    def hear(self):
        pose = PoseStamped()
        pose.header.frame_id = "base_link"
        pose.header.stamp = (self.get_clock().now() - Duration(seconds=0.03)).to_msg()
        pose.pose.orientation.w = 1.0
        self.poses.publish(pose)


class Fusion(Node):
    def __init__(self):
        super().__init__("fusion")
        self.buffer = Buffer(cache_time=Duration(seconds=5.0))
        self.listener = TransformListener(self.buffer, self, spin_thread=False)
        points = Subscriber(self, PointStamped, "camera/point")
        poses = Subscriber(self, PoseStamped, "beacon/pose")
        self.cache = Cache(points, 20)
        self.sync = ApproximateTimeSynchronizer([points, poses], queue_size=10, slop=0.06)
        self.sync.registerCallback(partial(self.on_pair, "pair"))
        self.early, self.there, self.far = {}, [], 0.0
        self.create_timer(4.0, self.report)

    def on_pair(self, word, point, pose):
        stamps = [Time.from_msg(each.header.stamp) for each in (point, pose)]
        self.far = max(self.far, abs((stamps[0] - stamps[1]).nanoseconds) / 1e9)
        try:
            in_map = self.buffer.transform(point, "map", timeout=Duration(seconds=0.0))
        except (LookupException, ConnectivityException, ExtrapolationException) as error:
            self.early[type(error).__name__] = self.early.get(type(error).__name__, 0) + 1
            return
        self.there.append((in_map.point.x, in_map.point.y, stamps[0].nanoseconds / 1e9))

    def report(self):
        slopes = [(b[0] - a[0]) / (b[2] - a[2]) for a, b in zip(self.there, self.there[1:]) if b[2] > a[2]]
        self.get_logger().info(f"early {sorted(self.early)}; pairs there: {len(self.there)}")
        self.get_logger().info(f"slope {sum(slopes) / len(slopes):.2f}, y {self.there[-1][1]:.2f}, slop {self.far <= 0.06}")
        oldest, newest = self.cache.getOldestTime(), self.cache.getLatestTime()
        self.get_logger().info(f"cached {(newest - oldest).nanoseconds / 1e9:.1f} s")
        try:
            self.buffer.lookup_transform("map", "nowhere", Time())
        except LookupException as error:
            self.get_logger().info(f"lookup: {error}")
        try:
            self.buffer.lookup_transform("map", "base_link", self.get_clock().now() + Duration(seconds=9.0))
        except ExtrapolationException as error:
            self.get_logger().info(f"future: {'future' in str(error)}")
        self.get_logger().info(f"can: {self.buffer.can_transform('camera', 'map', Time())}")
        self.executor.create_task(rclpy.try_shutdown)


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    nodes = [Robot(), Fusion()]
    for each in nodes:
        executor.add_node(each)
    try:
        executor.spin()
    except rclpy.executors.ExternalShutdownException:
        pass
    print("done")


if __name__ == "__main__":
    main()

"""A chain of moving frames, looked up in several ways, and points sent through it.

Meant: base -> shoulder (static) -> elbow (moving) -> hand (static). The hand's place follows from
trigonometry; a lookup in the past gives the past place; a frame that is not there raises
LookupException, a time too far ahead ExtrapolationException; a coroutine waits for a transform.
"""
import math

import rclpy
import tf2_geometry_msgs
from geometry_msgs.msg import PointStamped, PoseStamped, TransformStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import (Buffer, ConnectivityException, ExtrapolationException, LookupException,
                     StaticTransformBroadcaster, TransformBroadcaster, TransformListener)


def link(parent, child, stamp, x=0.0, y=0.0, yaw=0.0):
    t = TransformStamped()
    t.header.stamp = stamp
    t.header.frame_id = parent
    t.child_frame_id = child
    t.transform.translation.x = x
    t.transform.translation.y = y
    t.transform.rotation.z = math.sin(yaw / 2)
    t.transform.rotation.w = math.cos(yaw / 2)
    return t


class Arm(Node):
    SPEED = 0.5

    def __init__(self):
        super().__init__('arm')
        self.begin = self.get_clock().now()
        self.static = StaticTransformBroadcaster(self)
        stamp = self.begin.to_msg()
        self.static.sendTransform([link('base', 'shoulder', stamp, x=0.2),
                                   link('elbow', 'hand', stamp, x=0.5)])
        self.moving = TransformBroadcaster(self)
        self.create_timer(0.05, self.move)

    def angle(self, time):
        return self.SPEED * (time - self.begin).nanoseconds / 1e9

    def move(self):
        now = self.get_clock().now()
        self.moving.sendTransform(link('shoulder', 'elbow', now.to_msg(), x=1.0, yaw=self.angle(now)))


class Watcher(Node):
    def __init__(self, arm):
        super().__init__('watcher')
        self.arm = arm
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(2.0, self.look)
        self.done = False
        self.create_task_once = self.create_timer(0.01, self.wait_first)

    async def wait_first(self):
        self.create_task_once.cancel()
        await self.buffer.wait_for_transform_async('base', 'hand', Time())
        print('first transform came')

    def hand(self, time):
        a = self.arm.angle(time)
        return 1.2 + 0.5 * math.cos(a), 0.5 * math.sin(a)

    def close(self, transform):
        time = Time.from_msg(transform.header.stamp)
        x, y = self.hand(time)
        p = transform.transform.translation
        return math.hypot(p.x - x, p.y - y) < 0.002

    def look(self):
        if self.done:
            return
        self.done = True
        now = self.get_clock().now()
        print('latest', self.close(self.buffer.lookup_transform('base', 'hand', Time())))
        past = now - Duration(seconds=1)
        print('past', self.close(self.buffer.lookup_transform('base', 'hand', past)))
        full = self.buffer.lookup_transform_full('hand', past, 'hand', past - Duration(seconds=0.5), 'base')
        print('moved in half a second', abs(2 * math.asin(abs(full.transform.rotation.z)) - 0.25) < 0.01)
        for target, time in (('foot', Time()), ('hand', now + Duration(seconds=5))):
            try:
                self.buffer.lookup_transform('base', target, time)
            except (LookupException, ConnectivityException, ExtrapolationException) as error:
                print(target, type(error).__name__)
        point = PointStamped()
        point.header.frame_id = 'hand'
        point.point.x = 0.1
        there = self.buffer.transform(point, 'base')
        length = math.hypot(there.point.x - 1.2, there.point.y)
        print('fingertip', there.header.frame_id, abs(length - 0.6) < 0.002)
        pose = PoseStamped()
        pose.header.frame_id = 'base'
        pose.pose.orientation.w = 1.0
        inverse = self.buffer.lookup_transform('shoulder', 'base', Time())
        moved = tf2_geometry_msgs.do_transform_pose(pose.pose, inverse)
        print('pose', round(moved.position.x, 3))
        print('elbow known', 'elbow' in self.buffer.all_frames_as_string())


def main():
    rclpy.init()
    arm = Arm()
    watcher = Watcher(arm)
    executor = rclpy.executors.MultiThreadedExecutor()
    for node in (arm, watcher):
        executor.add_node(node)
    while not watcher.done:
        executor.spin_once(timeout_sec=0.1)
    rclpy.shutdown()


if __name__ == '__main__':
    main()

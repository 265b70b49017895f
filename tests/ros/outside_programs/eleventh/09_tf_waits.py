import math
import threading

import rclpy
import yaml
from geometry_msgs.msg import TransformStamped
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import (Buffer, ConnectivityException, ExtrapolationException, LookupException,
                     StaticTransformBroadcaster, TransformBroadcaster, TransformException, TransformListener)
from tf_transformations import quaternion_from_euler


def transform(parent, child, stamp, x=0.0, y=0.0, yaw=0.0):
    t = TransformStamped()
    t.header.stamp, t.header.frame_id, t.child_frame_id = stamp.to_msg(), parent, child
    t.transform.translation.x, t.transform.translation.y = x, y
    q = quaternion_from_euler(0, 0, yaw)
    r = t.transform.rotation
    r.x, r.y, r.z, r.w = q
    return t


class Broadcaster(Node):
    """Starts to publish after 1.5 s; odom -> base_link moves by 0.5 m/s along x."""

    def __init__(self):
        super().__init__('broadcaster')
        self.tf = TransformBroadcaster(self)
        self.static = StaticTransformBroadcaster(self)
        self.begin = self.get_clock().now()
        self.sent = False
        self.create_timer(0.05, self.tick)

    def tick(self):
        now = self.get_clock().now()
        if now - self.begin < Duration(seconds=1.5):
            return
        if not self.sent:
            self.static.sendTransform([
                transform('base_link', 'arm', now, x=0.5), transform('arm', 'hand', now, y=0.25, yaw=math.pi / 2)])
            self.sent = True
        self.tf.sendTransform(transform('odom', 'base_link', now, x=(now - self.begin).nanoseconds * 0.5e-9))


class Waiter(Node):
    def __init__(self, done):
        super().__init__('waiter')
        self.done = done
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.group = MutuallyExclusiveCallbackGroup()
        self.timer = self.create_timer(0.1, self.work, callback_group=self.group)
        self.async_timer = self.create_timer(0.1, self.work_async, callback_group=ReentrantCallbackGroup())
        self.lines = threading.Lock()
        self.both = 0

    def say(self, text):
        with self.lines:
            self.get_logger().info(text)

    def work(self):
        self.timer.cancel()
        try:
            self.buffer.lookup_transform('base_link', 'arm', Time())
        except (LookupException, ConnectivityException) as error:
            self.say(f'not yet: {type(error).__name__}')
        t = self.buffer.lookup_transform('base_link', 'arm', Time(), timeout=Duration(seconds=5.0))
        self.say(f'blocking got x {t.transform.translation.x}')
        self.both += 1

    async def work_async(self):
        self.async_timer.cancel()
        t = await self.buffer.lookup_transform_async('arm', 'hand', Time())
        while self.both == 0:
            await self.pause(0.05)
        self.say(f'async got y {t.transform.translation.y}')
        self.both += 1
        self.rest_timer = self.create_timer(1.5, self.rest, callback_group=self.group)

    async def pause(self, seconds):
        future = rclpy.task.Future()
        timer = self.create_timer(
            seconds, lambda: future.done() or future.set_result(None), callback_group=ReentrantCallbackGroup())
        await future
        self.destroy_timer(timer)

    def rest(self):
        self.rest_timer.cancel()
        begin = self.get_clock().now()
        try:
            self.buffer.lookup_transform('odom', 'unicorn', Time(), timeout=Duration(seconds=0.3))
        except TransformException:
            self.say(f'timed out after {(self.get_clock().now() - begin).nanoseconds / 1e9:.1f}')
        frames = yaml.safe_load(self.buffer.all_frames_as_yaml())
        self.say(f'parents: {dict(sorted((name, each["parent"]) for name, each in frames.items()))}')
        latest = Time.from_msg(self.buffer.lookup_transform('odom', 'base_link', Time()).header.stamp)
        t = self.buffer.lookup_transform_full(
            target_frame='base_link', target_time=latest - Duration(seconds=1.0),
            source_frame='base_link', source_time=latest, fixed_frame='odom', timeout=Duration(seconds=1.0))
        self.say(f'moved {t.transform.translation.x:.1f} m in the last second')
        try:
            self.buffer.lookup_transform('odom', 'base_link', latest + Duration(seconds=60))
        except ExtrapolationException as error:
            self.say(f'future: {type(error).__name__}')
        self.done.set_result(True)


def main():
    rclpy.init()
    done = rclpy.task.Future()
    executor = MultiThreadedExecutor()
    nodes = [Broadcaster(), Waiter(done)]
    for node in nodes:
        executor.add_node(node)
    executor.spin_until_future_complete(done)
    for node in nodes:
        node.destroy_node()
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

import math

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from std_srvs.srv import Trigger
from tf2_ros import TransformBroadcaster, TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from tf2_ros.transform_listener import TransformListener

GRAVITY = 9.81
HEIGHT = 9.0


class Arena(Node):
    """Publishes the frame of the brick; 250 Hz as the homework asks."""

    def __init__(self):
        super().__init__('arena')
        self.static = StaticTransformBroadcaster(self)
        t = TransformStamped()
        t.header.stamp = self.get_clock().now().to_msg()
        t.header.frame_id = 'world'
        t.child_frame_id = 'odom'
        t.transform.translation.x = 5.5
        t.transform.translation.y = 5.5
        self.static.sendTransform(t)
        self.broadcaster = TransformBroadcaster(self)
        self.z, self.v, self.falling = HEIGHT, 0.0, False
        self.create_service(Trigger, 'drop', self.drop)
        self.timer = self.create_timer(1.0 / 250.0, self.step)

    def drop(self, request, response):
        response.success = not self.falling
        self.falling = True
        return response

    def step(self):
        if self.falling and self.z > 0.0:
            self.v += GRAVITY / 250.0
            self.z = max(0.0, self.z - self.v / 250.0)
        t = TransformStamped()
        t.header.stamp = self.get_clock().now().to_msg()
        t.header.frame_id = 'world'
        t.child_frame_id = 'brick'
        t.transform.translation.x, t.transform.translation.y = 4.5, 6.0
        t.transform.translation.z = self.z
        t.transform.rotation.w = 1.0
        self.broadcaster.sendTransform(t)


class Catcher(Node):
    def __init__(self):
        super().__init__('catcher')
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.client = self.create_client(Trigger, 'drop')
        self.client.wait_for_service()
        self.future = None
        self.last = None
        self.falls = 0
        self.started = None
        self.timer = self.create_timer(0.02, self.watch)

    def watch(self):
        if not self.buffer.can_transform('odom', 'brick', Time()):
            return
        try:
            t = self.buffer.lookup_transform('odom', 'brick', Time())
        except TransformException as ex:
            self.get_logger().info(f'no transform: {ex}')
            return
        where = t.transform.translation
        if self.future is None:
            self.future = self.client.call_async(Trigger.Request())
            self.future.add_done_callback(lambda f: print('dropped', f.result().success))
            print('in odom x', round(where.x, 3), 'y', round(where.y, 3))
        if self.last is not None and where.z < self.last - 1e-6:
            self.falls += 1
            if self.falls == 1:
                self.started = Time.from_msg(t.header.stamp)
                print('falling', self.falls)
        if self.started is not None and where.z == 0.0:
            took = (Time.from_msg(t.header.stamp) - self.started).nanoseconds / 1e9
            assert abs(took - math.sqrt(2 * HEIGHT / GRAVITY)) < 0.1, took
            print(f'landed after {took:.2f} s')
            rclpy.shutdown()
        self.last = where.z


def main():
    rclpy.init()
    arena, catcher = Arena(), Catcher()
    executor = SingleThreadedExecutor()
    executor.add_node(arena)
    executor.add_node(catcher)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
# broadcaster for both turtles and listener in one file; turtle2 drives after turtle1 by tf
import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import TransformStamped, Twist
from tf2_ros import TransformBroadcaster, TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener
from turtlesim.msg import Pose
from turtlesim.srv import Spawn
from functools import partial


def quaternion_from_yaw(yaw):
    return math.sin(yaw / 2), math.cos(yaw / 2)


class Broadcaster(Node):
    def __init__(self):
        super().__init__('turtle_tf2_frame_publisher')
        self.tf_broadcaster = TransformBroadcaster(self)
        self.subs = [self.create_subscription(Pose, f'/{name}/pose', partial(self.handle_pose, name), 1)
                     for name in ('turtle1', 'turtle2')]

    def handle_pose(self, name, msg):
        t = TransformStamped()
        t.header.stamp = self.get_clock().now().to_msg()
        t.header.frame_id = 'world'
        t.child_frame_id = name
        t.transform.translation.x = msg.x
        t.transform.translation.y = msg.y
        t.transform.rotation.z, t.transform.rotation.w = quaternion_from_yaw(msg.theta)
        self.tf_broadcaster.sendTransform(t)


class Listener(Node):
    def __init__(self):
        super().__init__('turtle_tf2_frame_listener')
        self.tf_buffer = Buffer()
        self.tf_listener = TransformListener(self.tf_buffer, self)
        self.spawner = self.create_client(Spawn, 'spawn')
        self.requested = False
        self.ready = False
        self.publisher = self.create_publisher(Twist, 'turtle2/cmd_vel', 1)
        self.timer = self.create_timer(0.1, self.on_timer)
        self.close = 0

    def on_timer(self):
        if not self.requested:
            if self.spawner.service_is_ready():
                self.result = self.spawner.call_async(Spawn.Request(name='turtle2', x=9.0, y=2.0, theta=0.0))
                self.requested = True
            return
        if not self.ready:
            if self.result.done():
                self.get_logger().info(f'Successfully spawned {self.result.result().name}')
                self.ready = True
            return
        try:
            t = self.tf_buffer.lookup_transform('turtle2', 'turtle1', rclpy.time.Time())
        except TransformException as ex:
            self.get_logger().info(f'Could not transform: {ex}', throttle_duration_sec=1.0)
            return
        dx, dy = t.transform.translation.x, t.transform.translation.y
        msg = Twist()
        msg.angular.z = 2.0 * math.atan2(dy, dx)
        msg.linear.x = 0.5 * math.hypot(dx, dy)
        self.publisher.publish(msg)
        if math.hypot(dx, dy) < 0.3:
            self.get_logger().info('turtle2 is with turtle1', once=True)


def main():
    rclpy.init()
    ex = rclpy.executors.SingleThreadedExecutor()
    for node in (Broadcaster(), Listener()):
        ex.add_node(node)
    ex.spin()


if __name__ == '__main__':
    try:
        main()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass

#!/usr/bin/env python3
"""First turtle draws a circle and stops; a second is spawned there, draws a larger one and stops."""
import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose
from turtlesim.srv import Spawn


class TwoCircles(Node):
    def __init__(self):
        super().__init__('two_circles')
        self.pose = None
        self.turned = 0.0
        self.state = 'first'
        self.name = 'turtle1'
        self.follow('turtle1')
        self.spawn_client = self.create_client(Spawn, 'spawn')
        while not self.spawn_client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info('spawn is not available, waiting again...')
        self.create_timer(0.05, self.step)

    def follow(self, name):
        self.pose = None
        self.turned = 0.0
        self.cmd = self.create_publisher(Twist, f'/{name}/cmd_vel', 10)
        self.sub = self.create_subscription(Pose, f'/{name}/pose', self.on_pose, 10)

    def on_pose(self, msg):
        if self.pose is not None:
            d = msg.theta - self.pose.theta
            self.turned += math.atan2(math.sin(d), math.cos(d))
        self.pose = msg

    def step(self):
        if self.state in ('waiting', 'done') or self.pose is None:
            return
        if abs(self.turned) < 2 * math.pi:
            v = 1.0 if self.state == 'first' else 2.0
            self.cmd.publish(Twist(linear=self.vec(x=v), angular=self.vec(z=1.0)))
            return
        self.cmd.publish(Twist())
        self.get_logger().info(f'{self.state} circle done at {self.pose.x:.1f}, {self.pose.y:.1f}')
        if self.state == 'first':
            self.state = 'waiting'
            request = Spawn.Request(x=self.pose.x, y=self.pose.y, theta=self.pose.theta, name='second')
            self.spawn_client.call_async(request).add_done_callback(self.spawned)
        else:
            self.state = 'done'
            raise SystemExit

    @staticmethod
    def vec(**kw):
        from geometry_msgs.msg import Vector3
        return Vector3(**kw)

    def spawned(self, future):
        name = future.result().name
        self.get_logger().info(f'spawned {name}')
        self.destroy_subscription(self.sub)
        self.destroy_publisher(self.cmd)
        self.follow(name)
        self.state = 'second'


def main():
    rclpy.init()
    node = TwoCircles()
    try:
        rclpy.spin(node)
    except SystemExit:
        rclpy.logging.get_logger('main').info('finished')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

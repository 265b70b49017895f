#!/usr/bin/env python3
"""A ballet: whatever turtles there are, found by the graph, circle together until all have turned once."""
import math
import re

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import QoSProfile
from turtlesim.msg import Pose
from turtlesim.srv import Kill, Spawn


class Dancer:
    def __init__(self, node, name):
        self.name = name
        self.angle = 0.0
        self.last = None
        self.pub = node.create_publisher(Twist, f'{name}/cmd_vel', QoSProfile(depth=10))
        self.sub = node.create_subscription(Pose, f'{name}/pose', self.on_pose, 10)

    def on_pose(self, pose):
        if self.last is not None:
            self.angle += math.remainder(pose.theta - self.last, math.tau)
        self.last = pose.theta

    def dance(self):
        cmd = Twist()
        if self.angle < math.tau:
            cmd.linear.x, cmd.angular.z = 1.0, 1.0
        self.pub.publish(cmd)


class Ballet(Node):
    def __init__(self):
        super().__init__('ballet')
        self.dancers = {}
        self.spawner = self.create_client(Spawn, 'spawn')
        self.killer = self.create_client(Kill, 'kill')
        self.spawner.wait_for_service()
        for i, x in enumerate((2.5, 8.5)):
            self.spawner.call_async(Spawn.Request(x=x, y=7.5, theta=0.0, name=f'swan{i}')).add_done_callback(self.spawned)
        self.create_timer(0.5, self.discover)
        self.create_timer(0.05, self.dance)
        self.dying = None

    def spawned(self, future):
        self.get_logger().info(f'{future.result().name} enters')

    def discover(self):
        for topic, types in self.get_topic_names_and_types():
            match = re.fullmatch(r'/(\w+)/pose', topic)
            if match and 'turtlesim/msg/Pose' in types and match[1] not in self.dancers:
                self.dancers[match[1]] = Dancer(self, match[1])

    def dance(self):
        for dancer in self.dancers.values():
            dancer.dance()
        if len(self.dancers) == 3 and all(d.angle >= math.tau for d in self.dancers.values()) and self.dying is None:
            self.dying = self.killer.call_async(Kill.Request(name='swan0'))


def main():
    rclpy.init()
    ballet = Ballet()
    while ballet.dying is None or not ballet.dying.done():
        rclpy.spin_once(ballet)
    publishers = ballet.get_publishers_info_by_topic('/turtle1/pose')
    print('pose by', publishers[0].node_name, publishers[0].topic_type)
    print('servers', sorted(n for n, _ in ballet.get_service_names_and_types_by_node('turtlesim', '/') if n in ('/kill', '/spawn', '/clear')))
    print('clients', sorted(n for n, _ in ballet.get_client_names_and_types_by_node('ballet', '/')))
    print('turned', [round(d.angle) for d in ballet.dancers.values()], flush=True)
    ballet.destroy_node()
    rclpy.shutdown()


main()

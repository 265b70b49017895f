#!/usr/bin/env python3
"""A small behaviour tree by hand: sequence, fallback, inverter, with generators as running leaves."""
import math
from abc import ABC, abstractmethod
from functools import partial
from typing import Iterator

import rclpy
from geometry_msgs.msg import TwistStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_srvs.srv import SetBool, Trigger

SUCCESS, FAILURE, RUNNING = 'SUCCESS', 'FAILURE', 'RUNNING'


class Behaviour(ABC):
    @abstractmethod
    def tick(self) -> str:
        ...


class Sequence(Behaviour):
    def __init__(self, *children):
        self.children, self.current = children, 0

    def tick(self):
        while self.current < len(self.children):
            status = self.children[self.current].tick()
            if status != SUCCESS:
                if status == FAILURE:
                    self.current = 0
                return status
            self.current += 1
        self.current = 0
        return SUCCESS


class Fallback(Behaviour):
    def __init__(self, *children):
        self.children = children

    def tick(self):
        for child in self.children:
            status = child.tick()
            if status != FAILURE:
                return status
        return FAILURE


class Condition(Behaviour):
    def __init__(self, test):
        self.test = test

    def tick(self):
        return SUCCESS if self.test() else FAILURE


class Action(Behaviour):
    def __init__(self, make):
        self.make, self.work = make, None

    def tick(self):
        self.work = self.work or self.make()
        try:
            next(self.work)
            return RUNNING
        except StopIteration as end:
            self.work = None
            return end.value or SUCCESS


class Robot(Node):
    def __init__(self):
        super().__init__('tree')
        qos = QoSProfile(history=QoSHistoryPolicy.KEEP_LAST, depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)
        self.front, self.yaw, self.turns, self.enabled = math.inf, 0.0, 0, False
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.copy = self.create_publisher(TwistStamped, '~/command', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, qos)
        self.create_subscription(Odometry, 'odom', self.on_odom, qos)
        self.create_service(SetBool, '~/enable', self.on_enable)
        self.create_service(Trigger, '~/turns', lambda _, r: Trigger.Response(success=True, message=str(self.turns)))
        self.tree = Fallback(
            Sequence(Condition(lambda: not self.enabled), Action(partial(self.halt))),
            Sequence(Condition(lambda: self.front < 2.0), Action(self.turn)),
            Action(self.cruise))
        self.create_timer(1 / 20, self.tree.tick)

    def on_enable(self, request, response):
        self.enabled = request.data
        response.success, response.message = True, f'enabled: {self.enabled}'
        return response

    def on_scan(self, msg):
        n = len(msg.ranges)
        self.front = min(msg.ranges[i % n] for i in range(-15, 16))

    def on_odom(self, msg):
        q = msg.pose.pose.orientation
        self.yaw = 2 * math.atan2(q.z, q.w)

    def drive(self, v, w):
        t = Twist()
        t.linear.x, t.angular.z = v, w
        self.cmd.publish(t)
        s = TwistStamped(twist=t)
        s.header.stamp = self.get_clock().now().to_msg()
        self.copy.publish(s)

    def halt(self) -> Iterator[None]:
        self.drive(0.0, 0.0)
        return
        yield

    def cruise(self):
        self.drive(0.6, 0.0)
        yield

    def turn(self):
        start = self.yaw
        self.get_logger().info('turning at %.1f m' % self.front)
        while abs(math.remainder(self.yaw - start, math.tau)) < math.pi / 2:
            self.drive(0.0, 1.0)
            yield
        self.turns += 1
        self.drive(0.0, 0.0)
        for _ in range(4):
            yield
        return SUCCESS


if __name__ == '__main__':
    rclpy.init()
    try:
        rclpy.spin(Robot())
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass

"""Drives a turtle along waypoints, over and over."""

import math
from enum import Enum, auto

import rclpy
from course_interfaces.msg import ErrorMetric
from course_interfaces.srv import Waypoints
from geometry_msgs.msg import Point, Twist, Vector3
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.msg import Pose
from turtlesim.srv import SetPen, TeleportAbsolute


class State(Enum):
    STOPPED = auto()
    MOVING = auto()


def distance(a, b):
    return math.hypot(a.x - b.x, a.y - b.y)


class Waypoint(Node):
    def __init__(self):
        super().__init__('waypoint')
        self.declare_parameter('frequency', 50.0, ParameterDescriptor(description='The control frequency'))
        self.declare_parameter('tolerance', 0.1)
        self.frequency = self.get_parameter('frequency').get_parameter_value().double_value
        self.tolerance = self.get_parameter('tolerance').value
        self.state = State.STOPPED
        self.points = []
        self.index = 0
        self.pose = None
        self.travelled = 0.0
        self.cb_group = MutuallyExclusiveCallbackGroup()
        self.pen = self.create_client(SetPen, 'turtle1/set_pen', callback_group=self.cb_group)
        self.teleport = self.create_client(
            TeleportAbsolute, 'turtle1/teleport_absolute', callback_group=self.cb_group)
        while not self.pen.wait_for_service(timeout_sec=1.0):
            self.get_logger().info('waiting for turtlesim')
        self.create_service(Empty, 'toggle', self.toggle)
        self.create_service(Waypoints, 'load', self.load)
        self.pub = self.create_publisher(Twist, 'turtle1/cmd_vel', 10)
        self.metrics = self.create_publisher(ErrorMetric, 'loop_metrics', 10)
        self.create_subscription(Pose, 'turtle1/pose', self.on_pose, 10)
        self.tmr = self.create_timer(1 / self.frequency, self.timer_callback)

    def toggle(self, request, response):
        if self.state is State.MOVING:
            self.state = State.STOPPED
            self.get_logger().info('Stopping')
        elif not self.points:
            self.get_logger().error('early toggle: no waypoints loaded. Load them with the "load" service.')
        else:
            self.state = State.MOVING
            self.get_logger().debug('moving')
        return response

    async def load(self, request, response):
        self.points = list(request.mixer)
        total = sum(distance(a, b) for a, b in zip(self.points, self.points[1:] + self.points[:1]))
        off, on = SetPen.Request(off=1), SetPen.Request(r=255, g=0, b=0, width=2, off=0)
        for point in self.points:
            for dx in (-0.2, 0.2):
                await self.pen.call_async(off)
                await self.teleport.call_async(TeleportAbsolute.Request(x=point.x - dx, y=point.y - 0.2))
                await self.pen.call_async(on)
                await self.teleport.call_async(TeleportAbsolute.Request(x=point.x + dx, y=point.y + 0.2))
        await self.pen.call_async(off)
        first = self.points[0]
        await self.teleport.call_async(TeleportAbsolute.Request(x=first.x, y=first.y, theta=0.0))
        await self.pen.call_async(SetPen.Request(r=100, g=100, b=255, width=3))
        self.index = 1
        response.distance = total
        return response

    def on_pose(self, msg):
        if self.pose is not None and self.state is State.MOVING:
            self.travelled += distance(self.pose, msg)
        self.pose = msg

    def timer_callback(self):
        if self.state is State.STOPPED or self.pose is None:
            return
        goal = self.points[self.index]
        if distance(self.pose, goal) < self.tolerance:
            self.index = (self.index + 1) % len(self.points)
            if self.index == 1:
                straight = sum(distance(a, b) for a, b in zip(self.points, self.points[1:] + self.points[:1]))
                metric = ErrorMetric(actual_distance=self.travelled, straight_distance=straight)
                metric.error = abs(self.travelled - straight) / straight
                self.metrics.publish(metric)
                self.get_logger().info(f'metric error {metric.error:.3f}')
            return
        turn = math.atan2(goal.y - self.pose.y, goal.x - self.pose.x) - self.pose.theta
        turn = math.atan2(math.sin(turn), math.cos(turn))
        forward = 1.5 if abs(turn) < 0.2 else 0.0
        self.pub.publish(Twist(linear=Vector3(x=forward, y=0.0, z=0.0), angular=Vector3(z=4.0 * turn)))


def main(args=None):
    rclpy.init(args=args)
    node = Waypoint()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

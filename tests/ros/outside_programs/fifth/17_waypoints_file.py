#!/usr/bin/env python3
"""Reads waypoints beside itself, publishes them as PoseArray, visits them, writes a report as JSON."""
import json
import math
import pathlib
import tempfile
from dataclasses import asdict, dataclass
from enum import Enum, auto

import rclpy
import yaml
from geometry_msgs.msg import Pose, PoseArray, PoseWithCovarianceStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


@dataclass
class Waypoint:
    x: float
    y: float
    name: str


class State(Enum):
    TURN = auto()
    GO = auto()
    DONE = auto()


class Visitor(Node):
    def __init__(self):
        super().__init__('visitor')
        default = pathlib.Path(__file__).resolve().parent / 'waypoints.yml'
        file = pathlib.Path(self.declare_parameter('file', str(default)).value)
        content = yaml.safe_load(file.read_text())
        self.speed = content['speed']
        self.waypoints = [Waypoint(**w) for w in content['waypoints']]
        poses = PoseArray()
        poses.header.frame_id = content['frame_id']
        poses.header.stamp = self.get_clock().now().to_msg()
        for w in self.waypoints:
            p = Pose()
            p.position.x, p.position.y = w.x, w.y
            poses.poses.append(p)
        self.create_publisher(PoseArray, 'waypoints', 1).publish(poses)
        self.amcl = self.create_publisher(PoseWithCovarianceStamped, 'amcl_pose', 1)
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 1)
        self.state, self.log = State.TURN, []
        self.create_subscription(Odometry, 'odom', self.step, 1)

    def step(self, odom):
        estimate = PoseWithCovarianceStamped()
        estimate.header = odom.header
        estimate.pose = odom.pose
        estimate.pose.covariance[0] = estimate.pose.covariance[7] = 0.01
        self.amcl.publish(estimate)
        if self.state is State.DONE:
            return
        target = self.waypoints[len(self.log)]
        p, q = odom.pose.pose.position, odom.pose.pose.orientation
        yaw = math.atan2(2.0 * q.w * q.z, 1.0 - 2.0 * q.z * q.z)
        bearing = math.remainder(math.atan2(target.y - p.y, target.x - p.x) - yaw, 2 * math.pi)
        gap = math.hypot(target.x - p.x, target.y - p.y)
        out = Twist()
        if gap < 0.08:
            self.log.append({**asdict(target), 't': round(self.get_clock().now().nanoseconds / 1e9, 2)})
            self.get_logger().info(f'at {target.name}')
            self.state = State.DONE if len(self.log) == len(self.waypoints) else State.TURN
        elif self.state is State.TURN and abs(bearing) > 0.05:
            out.angular.z = math.copysign(max(0.2, min(1.2, 1.5 * abs(bearing))), bearing)
        else:
            self.state = State.GO
            out.linear.x, out.angular.z = min(self.speed, 0.1 + gap), 1.5 * bearing
        self.cmd.publish(out)


def main(args=None):
    rclpy.init(args=args)
    visitor = Visitor()
    while visitor.state is not State.DONE:
        rclpy.spin_once(visitor, timeout_sec=0.5)
    with tempfile.NamedTemporaryFile('w+', suffix='.json') as file:
        json.dump(visitor.log, file)
        file.flush()
        back = json.loads(pathlib.Path(file.name).read_text())
    print([w['name'] for w in back], sorted(w['t'] for w in back) == [w['t'] for w in back], flush=True)
    visitor.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
"""A floor cleaner: a state machine with a switch, a battery and a dock, on the real robot's topics.

Meant: WAITING until the service switches it on; then CLEANING (drive, BACKING when a wall is near,
TURNING to a side that changes) until the battery is low; HOMING turns to where it began and drives
there as far as the way is free; DOCKED ends. It never comes nearer than 0.15 m to anything.
"""
import enum
import math
import random

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import QoSPresetProfiles
from sensor_msgs.msg import BatteryState, LaserScan
from std_srvs.srv import SetBool


class Mode(enum.Enum):
    WAITING = enum.auto()
    CLEANING = enum.auto()
    BACKING = enum.auto()
    TURNING = enum.auto()
    HOMING = enum.auto()
    DOCKED = enum.auto()


class Cleaner(Node):
    def __init__(self):
        super().__init__('cleaner')
        self.mode = Mode.WAITING
        self.since = self.get_clock().now()
        self.random = random.Random(4)
        self.side = 1
        self.level = 1.0
        self.scan = self.pose = self.home = None
        self.closest = math.inf
        self.visited = set()
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.battery = self.create_publisher(BatteryState, 'battery', 10)
        self.create_subscription(
            LaserScan, 'scan', self.on_scan, QoSPresetProfiles.get_from_short_key('sensor_data'))
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.create_subscription(BatteryState, 'battery', self.on_battery, 10)
        self.create_service(SetBool, 'clean', self.on_switch)
        self.create_timer(0.1, self.step)
        self.create_timer(1.0, self.drain)

    def go(self, mode):
        self.get_logger().info(f'{self.mode.name} -> {mode.name}')
        self.mode = mode
        self.since = self.get_clock().now()

    def elapsed(self):
        return (self.get_clock().now() - self.since).nanoseconds * 1e-9

    def on_switch(self, request, response):
        response.success = self.mode is Mode.WAITING and request.data
        if response.success:
            self.go(Mode.CLEANING)
        return response

    def on_scan(self, scan):
        self.scan = scan
        good = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
        if good:
            self.closest = min(self.closest, min(good))

    def on_odom(self, odom):
        p, q = odom.pose.pose.position, odom.pose.pose.orientation
        self.pose = (p.x, p.y, 2 * math.atan2(q.z, q.w))
        self.home = self.home or self.pose
        self.visited.add((round(p.x / 0.3), round(p.y / 0.3)))

    def drain(self):
        if self.mode is not Mode.WAITING:
            self.level -= 0.02
        self.battery.publish(BatteryState(percentage=self.level, present=True))

    def on_battery(self, state):
        if state.percentage < 0.2 and self.mode not in (Mode.HOMING, Mode.DOCKED, Mode.WAITING):
            self.go(Mode.HOMING)

    def ahead(self, width=0.6):
        s = self.scan
        best = s.range_max
        for i, r in enumerate(s.ranges):
            angle = math.remainder(s.angle_min + i * s.angle_increment, math.tau)
            if abs(angle) < width and s.range_min < r < best:
                best = r
        return best

    def step(self):
        if self.scan is None or self.pose is None:
            return
        out = Twist()
        match self.mode:
            case Mode.CLEANING:
                if self.ahead() < 0.45:
                    self.go(Mode.BACKING)
                else:
                    out.linear.x = 0.2
            case Mode.BACKING:
                out.linear.x = -0.1
                if self.elapsed() > 0.5:
                    self.side = -self.side
                    self.turn_for = self.random.uniform(1.0, 2.5)
                    self.go(Mode.TURNING)
            case Mode.TURNING:
                out.angular.z = 0.8 * self.side
                if self.elapsed() > self.turn_for:
                    self.go(Mode.CLEANING)
            case Mode.HOMING:
                dx, dy = self.home[0] - self.pose[0], self.home[1] - self.pose[1]
                bearing = math.remainder(math.atan2(dy, dx) - self.pose[2], math.tau)
                if math.hypot(dx, dy) < 0.1 or (abs(bearing) < 0.1 and self.ahead() < 0.4):
                    self.cmd.publish(Twist())
                    self.go(Mode.DOCKED)
                    return self.tell()
                out.angular.z = max(-1.0, min(1.0, 2 * bearing))
                out.linear.x = 0.2 if abs(bearing) < 0.2 else 0.0
        self.cmd.publish(out)

    def tell(self):
        self.get_logger().info(f'cells over ten: {len(self.visited) > 10}')
        self.get_logger().info(f'kept away: {self.closest > 0.15}')
        raise SystemExit(0)


def main():
    rclpy.init()
    node = Cleaner()
    switch = rclpy.create_node('switch')
    client = switch.create_client(SetBool, 'clean')
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(switch)
    client.wait_for_service()
    for wanted in (False, True, True):
        future = client.call_async(SetBool.Request(data=wanted))
        executor.spin_until_future_complete(future)
        print('switch', wanted, future.result().success)
    try:
        executor.spin()
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()

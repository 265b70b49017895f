#!/usr/bin/env python3
from enum import Enum, auto
import math

import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan


class State(Enum):
    FIX_YAW = auto()
    GO_STRAIGHT = auto()
    WALL_FOLLOW = auto()
    DONE = auto()
    UNREACHABLE = auto()


class Bug0(Node):
    def __init__(self):
        super().__init__('bug0')
        self.declare_parameter('des_pos', [3.0, 2.0])
        self.goal = self.get_parameter('des_pos').value
        self.state = State.FIX_YAW
        self.x = self.y = self.yaw = None
        self.regions = None
        self.follow_ticks = 0
        self.vel = self.create_publisher(Twist, '/cmd_vel', 10)
        self.create_subscription(Odometry, '/odom', self.clbk_odom, 10)
        self.create_subscription(LaserScan, '/scan', self.clbk_laser, qos_profile_sensor_data)
        self.create_timer(0.1, self.run)

    def clbk_odom(self, msg):
        self.x = msg.pose.pose.position.x
        self.y = msg.pose.pose.position.y
        q = msg.pose.pose.orientation
        self.yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2))

    def clbk_laser(self, msg):
        reg = {'right': 8.0, 'front': 8.0, 'left': 8.0}
        for i, r in enumerate(msg.ranges):
            if not math.isfinite(r) or r < msg.range_min:
                continue
            a = math.degrees(msg.angle_min + i * msg.angle_increment)
            a = (a + 180) % 360 - 180
            if -25 < a < 25:
                reg['front'] = min(reg['front'], r)
            elif 60 < a < 120:
                reg['left'] = min(reg['left'], r)
            elif -120 < a < -60:
                reg['right'] = min(reg['right'], r)
        self.regions = reg

    def go(self, state):
        self.get_logger().info(f'State changed to {state.name}')
        self.state = state

    def run(self):
        if self.yaw is None or self.regions is None:
            return
        dx, dy = self.goal[0] - self.x, self.goal[1] - self.y
        dist = math.hypot(dx, dy)
        err = math.atan2(dy, dx) - self.yaw
        err = math.atan2(math.sin(err), math.cos(err))
        cmd = Twist()
        if self.state is State.FIX_YAW:
            cmd.angular.z = 0.4 if err > 0 else -0.4
            if abs(err) < 0.06:
                cmd.angular.z = 0.0
                self.go(State.GO_STRAIGHT)
        elif self.state is State.GO_STRAIGHT:
            if dist < 0.2:
                self.go(State.DONE)
            elif self.regions['front'] < min(0.7, dist):
                self.go(State.WALL_FOLLOW)
            elif abs(err) > 0.25:
                self.go(State.FIX_YAW)
            else:
                cmd.linear.x = 0.4
                cmd.angular.z = 0.5 * err
        elif self.state is State.WALL_FOLLOW:
            self.follow_ticks += 1
            if self.regions['front'] < 0.9:
                cmd.angular.z = 0.4
            else:
                cmd.linear.x = 0.3
                if self.regions['right'] > 0.9:
                    cmd.angular.z = -0.3
            if self.follow_ticks > 30 and abs(err) < 0.3 and self.regions['front'] > 1.0:
                self.go(State.FIX_YAW)
        self.vel.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    bug = Bug0()
    try:
        rclpy.spin(bug)
    except KeyboardInterrupt:
        pass


if __name__ == '__main__':
    main()

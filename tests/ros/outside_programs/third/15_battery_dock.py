#!/usr/bin/env python3
"""A robot that tires: it wanders between two posts, and goes to its dock (where it started) when the battery is low."""
import enum
import math
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSPresetProfiles
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState
from std_srvs.srv import Trigger


class Mode(enum.Enum):
    WORK = enum.auto()
    DOCK = enum.auto()
    CHARGE = enum.auto()


class Battery(Node):
    def __init__(self):
        super().__init__('battery')
        self.level, self.charging, self.speed = 1.0, False, 0.0
        self.pub = self.create_publisher(BatteryState, 'battery_state', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, QoSPresetProfiles.SENSOR_DATA.value)
        self.create_service(Trigger, 'plug_in', self.plug_in)
        self.create_timer(0.5, self.tick)

    def on_odom(self, m):
        self.speed = abs(m.twist.twist.linear.x)

    def plug_in(self, request, response):
        self.charging = True
        response.success, response.message = True, f'at {self.level:.0%}'
        return response

    def tick(self):
        if self.charging:
            self.level = min(1.0, self.level + 0.1)
        else:
            self.level -= 0.01 + 0.04 * self.speed
        b = BatteryState()
        b.header.stamp = self.get_clock().now().to_msg()
        b.percentage = self.level
        b.power_supply_status = (BatteryState.POWER_SUPPLY_STATUS_CHARGING if self.charging
                                 else BatteryState.POWER_SUPPLY_STATUS_DISCHARGING)
        self.pub.publish(b)


class Worker(Node):
    POSTS = [(2.0, 1.0), (2.0, -1.0)]

    def __init__(self):
        super().__init__('worker')
        self.mode, self.i, self.asked = Mode.WORK, 0, None
        self.plug = self.create_client(Trigger, 'plug_in')
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(BatteryState, 'battery_state', self.on_battery, 10)
        self.create_subscription(Odometry, 'odom', self.control, 10)

    def enter(self, mode):
        self.get_logger().info(f'{self.mode.name} -> {mode.name}')
        self.mode = mode

    def on_battery(self, b):
        if self.mode is Mode.WORK and b.percentage < 0.4:
            self.enter(Mode.DOCK)
        elif self.mode is Mode.CHARGE and b.percentage >= 1.0 - 1e-6:
            self.get_logger().info('full, end of the shift')
            raise SystemExit

    def control(self, odom):
        if self.mode is Mode.CHARGE:
            return
        goal = (0.0, 0.0) if self.mode is Mode.DOCK else self.POSTS[self.i % 2]
        p, q = odom.pose.pose.position, odom.pose.pose.orientation
        dx, dy = goal[0] - p.x, goal[1] - p.y
        t = Twist()
        if math.hypot(dx, dy) < 0.1:
            if self.mode is Mode.DOCK:
                self.enter(Mode.CHARGE)
                self.plug.call_async(Trigger.Request()).add_done_callback(
                    lambda f: self.get_logger().info('plugged in ' + f.result().message))
            else:
                self.i += 1
        else:
            e = math.remainder(math.atan2(dy, dx) - 2 * math.atan2(q.z, q.w), math.tau)
            t.angular.z = max(-1.5, min(1.5, 2.5 * e))
            t.linear.x = 0.5 if abs(e) < 0.3 else 0.0
        self.pub.publish(t)


def main():
    rclpy.init()
    nodes = Battery(), Worker()
    ex = rclpy.executors.MultiThreadedExecutor(2)
    for n in nodes:
        ex.add_node(n)
    try:
        ex.spin()
    except SystemExit:
        pass
    finally:
        ex.shutdown(timeout_sec=1)
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()

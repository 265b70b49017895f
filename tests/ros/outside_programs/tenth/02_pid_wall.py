#!/usr/bin/env python3
"""Follow the wall on the right with a PID on the distance, gains as parameters.

Meant: find a wall, follow it for a minute without touching anything, more than four metres on
the way, and the gain may be changed while it drives (it changes its own by set_parameters at 20 s).
"""
import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan


class PID:
    def __init__(self, kp, ki, kd, limit):
        self.kp, self.ki, self.kd, self.limit = kp, ki, kd, limit
        self.total = 0.0
        self.last = None

    def __call__(self, error, dt):
        self.total = float(np.clip(self.total + error * dt, -0.5, 0.5))
        slope = 0.0 if self.last is None or dt <= 0 else (error - self.last) / dt
        self.last = error
        value = self.kp * error + self.ki * self.total + self.kd * slope
        return float(np.clip(value, -self.limit, self.limit))


class PidWall(Node):
    def __init__(self):
        super().__init__('pid_wall')
        positive = ParameterDescriptor(
            description='proportional gain',
            floating_point_range=[FloatingPointRange(from_value=0.0, to_value=10.0, step=0.0)])
        self.declare_parameter('kp', 1.5, positive)
        self.declare_parameters('', [('ki', 0.0), ('kd', 0.6), ('distance', 0.5), ('speed', 0.15)])
        self.pid = PID(self.get_parameter('kp').value, self.get_parameter('ki').value,
                       self.get_parameter('kd').value, 1.0)
        self.add_on_set_parameters_callback(self.on_parameters)
        self.pub = self.create_publisher(Twist, '/cmd_vel', 10)
        self.create_subscription(LaserScan, '/scan', self.on_scan, qos_profile_sensor_data)
        self.create_subscription(Odometry, '/odom', self.on_odom, 10)
        self.last_time = None
        self.place = None
        self.way = 0.0
        self.closest = math.inf
        self.create_timer(20.0, self.soften)
        self.create_timer(60.0, self.report)

    def on_parameters(self, parameters):
        for parameter in parameters:
            if parameter.name == 'kp' and parameter.type_ == Parameter.Type.DOUBLE:
                self.pid.kp = parameter.value
                self.get_logger().info(f'kp is {parameter.value:.1f} now')
        return SetParametersResult(successful=True)

    def soften(self):
        results = self.set_parameters([Parameter('kp', value=1.2)])
        refused = self.set_parameters([Parameter('kp', value=99.0)])
        self.get_logger().info(
            f'set: {results[0].successful}, too big: {refused[0].successful}', once=True)

    def on_odom(self, odom):
        place = odom.pose.pose.position
        if self.place is not None:
            self.way += math.hypot(place.x - self.place.x, place.y - self.place.y)
        self.place = place

    def sector(self, scan, low, high):
        ranges = np.array(scan.ranges)
        angles = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment
        angles = np.arctan2(np.sin(angles), np.cos(angles))
        good = (angles >= math.radians(low)) & (angles <= math.radians(high))
        good &= np.isfinite(ranges) & (ranges > scan.range_min)
        return float(ranges[good].min()) if good.any() else scan.range_max

    def on_scan(self, scan):
        now = self.get_clock().now()
        dt = 0.0 if self.last_time is None else (now - self.last_time).nanoseconds / 1e9
        self.last_time = now
        front = self.sector(scan, -25, 25)
        right = self.sector(scan, -100, -40)
        self.closest = min(self.closest, front, right, self.sector(scan, 0, 120))
        twist = Twist()
        if front < 0.55:
            twist.angular.z = 0.7
        else:
            twist.linear.x = self.get_parameter('speed').get_parameter_value().double_value
            error = self.get_parameter('distance').value - min(right, 1.0)
            twist.angular.z = self.pid(error, dt)
        self.pub.publish(twist)

    def report(self):
        self.get_logger().info(f'more than four metres: {self.way > 4.0}')
        self.get_logger().info(f'never touched: {self.closest > 0.12}')
        raise KeyboardInterrupt


def main(args=None):
    rclpy.init(args=args)
    node = PidWall()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.pub.publish(Twist())
        print('finished')
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()

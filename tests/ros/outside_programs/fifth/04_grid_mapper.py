#!/usr/bin/env python3
"""Occupancy grid mapping with known poses: log odds, Bresenham, poses by tf2."""
import numpy as np
import rclpy
import tf2_ros
from nav_msgs.msg import OccupancyGrid, MapMetaData
from nav_msgs.srv import GetMap
from rclpy.node import Node
from rclpy.time import Time
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan
import math

RES, SIZE = 0.25, 48
L_OCC, L_FREE = 0.9, -0.4


def bresenham(x0, y0, x1, y1):
    dx, dy = abs(x1 - x0), -abs(y1 - y0)
    sx, sy = (1 if x0 < x1 else -1), (1 if y0 < y1 else -1)
    err = dx + dy
    while True:
        yield x0, y0
        if x0 == x1 and y0 == y1:
            return
        e2 = 2 * err
        if e2 >= dy:
            err += dy
            x0 += sx
        if e2 <= dx:
            err += dx
            y0 += sy


class Mapper(Node):
    def __init__(self):
        super().__init__('mapper')
        self.log_odds = np.zeros((SIZE, SIZE))
        self.buffer = tf2_ros.Buffer(cache_time=rclpy.duration.Duration(seconds=5))
        self.listener = tf2_ros.TransformListener(self.buffer, self)
        qos = rclpy.qos.QoSProfile(depth=1)
        qos.durability = rclpy.qos.QoSDurabilityPolicy.TRANSIENT_LOCAL
        self.map_pub = self.create_publisher(OccupancyGrid, 'map', qos)
        self.cmd_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.scan_cb, 10)
        self.create_service(GetMap, 'dynamic_map', self.get_map)
        self.create_timer(1.0, self.publish_map)
        self.create_timer(0.1, self.drive)
        self.used = self.skipped = 0

    def drive(self):
        t = Twist()
        t.linear.x, t.angular.z = 0.3, 0.3
        self.cmd_pub.publish(t)

    def cell(self, x, y):
        return int(x / RES + SIZE / 2), int(y / RES + SIZE / 2)

    def scan_cb(self, scan):
        stamp = Time.from_msg(scan.header.stamp)
        if not self.buffer.can_transform('odom', scan.header.frame_id, stamp):
            try:
                tf = self.buffer.lookup_transform('odom', scan.header.frame_id, Time())
            except tf2_ros.TransformException:
                self.skipped += 1
                return
        else:
            tf = self.buffer.lookup_transform('odom', scan.header.frame_id, stamp)
        self.used += 1
        x, y = tf.transform.translation.x, tf.transform.translation.y
        yaw = 2 * math.atan2(tf.transform.rotation.z, tf.transform.rotation.w)
        here = self.cell(x, y)
        for i in range(0, len(scan.ranges), 4):
            r = scan.ranges[i]
            hit = math.isfinite(r)
            r = r if hit else scan.range_max
            a = yaw + scan.angle_min + i * scan.angle_increment
            there = self.cell(x + r * math.cos(a), y + r * math.sin(a))
            for cx, cy in bresenham(*here, *there):
                if 0 <= cx < SIZE and 0 <= cy < SIZE and (cx, cy) != there:
                    self.log_odds[cy, cx] += L_FREE
            if hit and 0 <= there[0] < SIZE and 0 <= there[1] < SIZE:
                self.log_odds[there[1], there[0]] += L_OCC

    def grid(self):
        grid = OccupancyGrid()
        grid.header.frame_id = 'odom'
        grid.header.stamp = self.get_clock().now().to_msg()
        grid.info = MapMetaData(resolution=RES, width=SIZE, height=SIZE)
        grid.info.origin.position.x = grid.info.origin.position.y = -SIZE / 2 * RES
        p = 1 - 1 / (1 + np.exp(np.clip(self.log_odds, -20, 20)))
        data = np.where(self.log_odds == 0, -1, np.round(100 * p)).astype(np.int8)
        grid.data = data.ravel().tolist()
        return grid

    def publish_map(self):
        self.map_pub.publish(self.grid())

    def get_map(self, request, response):
        response.map = self.grid()
        self.get_logger().info(f'map asked for: {self.used > 50}')
        return response


def main():
    rclpy.init()
    rclpy.spin(Mapper())


if __name__ == '__main__':
    main()

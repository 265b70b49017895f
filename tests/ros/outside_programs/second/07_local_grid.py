#!/usr/bin/env python3
import math
import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, DurabilityPolicy, qos_profile_sensor_data
from nav_msgs.msg import OccupancyGrid, MapMetaData
from geometry_msgs.msg import Pose, Point, Quaternion
from sensor_msgs.msg import LaserScan


class Mapper(Node):
    RES = 0.25
    N = 48          # 12 m x 12 m

    def __init__(self):
        super().__init__('mapper')
        self.hits = np.zeros((self.N, self.N), dtype=np.int32)
        self.scans = 0
        self.create_subscription(LaserScan, 'scan', self.add, qos_profile_sensor_data)
        self.pub = self.create_publisher(
            OccupancyGrid, 'local_map', QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        self.timer = self.create_timer(2.0, self.publish)

    def add(self, msg):
        r = np.frombuffer(msg.ranges, dtype=np.float32) if not isinstance(msg.ranges, list) else np.array(msg.ranges)
        a = msg.angle_min + msg.angle_increment * np.arange(r.size)
        good = np.isfinite(r) & (r > msg.range_min) & (r < msg.range_max)
        x, y = r[good] * np.cos(a[good]), r[good] * np.sin(a[good])
        i = np.floor(x / self.RES).astype(int) + self.N // 2
        j = np.floor(y / self.RES).astype(int) + self.N // 2
        np.add.at(self.hits, (j, i), 1)
        self.scans += 1

    def publish(self):
        if self.scans == 0:
            return
        grid = OccupancyGrid()
        grid.header.frame_id = 'base_link'
        grid.header.stamp = self.get_clock().now().to_msg()
        half = -self.N * self.RES / 2
        grid.info = MapMetaData(resolution=self.RES, width=self.N, height=self.N,
                                origin=Pose(position=Point(x=half, y=half), orientation=Quaternion(w=1.0)))
        occupied = self.hits > 0
        grid.data = [int(v) for v in np.where(occupied, 100, 0).astype(np.int8).ravel()]
        self.pub.publish(grid)
        ys, xs = np.nonzero(occupied)
        w = (xs.max() - xs.min()) * self.RES
        h = (ys.max() - ys.min()) * self.RES
        inside = int(occupied[self.N // 2 - 8:self.N // 2 + 8, self.N // 2 - 8:self.N // 2 + 8].sum())
        self.get_logger().info(f'room of about {w:.0f} x {h:.0f} m, {inside} occupied cells near the robot')


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Mapper())


if __name__ == '__main__':
    main()

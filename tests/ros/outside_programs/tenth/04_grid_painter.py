"""Paint an occupancy grid from scans and poses, publish it latched, and read it as a late subscriber.

Meant: after 5 s of turning on the spot the grid has free and occupied cells; a subscription made
only then, with transient local durability, gets the newest grid at once; a volatile one made at the
same time gets nothing (no grid is published any more).
"""
import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL,
                     reliability=ReliabilityPolicy.RELIABLE, history=HistoryPolicy.KEEP_LAST)
SIZE = 120
RESOLUTION = 0.1


class Painter(Node):
    def __init__(self):
        super().__init__('painter')
        self.cells = [-1] * (SIZE * SIZE)
        self.origin = None
        self.pose = None
        self.publisher = self.create_publisher(OccupancyGrid, 'painted', LATCHED)
        self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.timer = self.create_timer(1.0, self.publish)
        self.published = 0

    def on_odom(self, odom):
        p, q = odom.pose.pose.position, odom.pose.pose.orientation
        self.pose = (p.x, p.y, math.atan2(2 * q.w * q.z, 1 - 2 * q.z * q.z))
        if self.origin is None:
            self.origin = (p.x - SIZE * RESOLUTION / 2, p.y - SIZE * RESOLUTION / 2)
        self.commands.publish(Twist() if self.published >= 5 else self.turning())

    def turning(self):
        twist = Twist()
        twist.angular.z = 1.0
        return twist

    def index(self, x, y):
        column = int((x - self.origin[0]) / RESOLUTION)
        row = int((y - self.origin[1]) / RESOLUTION)
        return row * SIZE + column if 0 <= row < SIZE and 0 <= column < SIZE else None

    def on_scan(self, scan):
        if self.pose is None:
            return
        x, y, yaw = self.pose
        for number, distance in enumerate(scan.ranges):
            hit = math.isfinite(distance) and distance < scan.range_max
            if not hit:
                continue
            angle = yaw + scan.angle_min + number * scan.angle_increment
            step = 0.0
            while step < distance - RESOLUTION:
                cell = self.index(x + step * math.cos(angle), y + step * math.sin(angle))
                if cell is not None and self.cells[cell] != 100:
                    self.cells[cell] = 0
                step += RESOLUTION / 2
            cell = self.index(x + distance * math.cos(angle), y + distance * math.sin(angle))
            if cell is not None:
                self.cells[cell] = 100

    def publish(self):
        if self.origin is None:
            return
        grid = OccupancyGrid()
        grid.header.stamp = self.get_clock().now().to_msg()
        grid.header.frame_id = 'odom'
        grid.info = MapMetaData(resolution=RESOLUTION, width=SIZE, height=SIZE)
        grid.info.origin.position.x, grid.info.origin.position.y = self.origin
        grid.info.origin.orientation.w = 1.0
        grid.data = self.cells
        self.publisher.publish(grid)
        self.published += 1
        if self.published == 5:
            self.timer.cancel()
            self.get_logger().info('five grids published')


class Reader(Node):
    def __init__(self):
        super().__init__('reader')
        self.got = {'latched': 0, 'volatile': 0}
        self.create_subscription(OccupancyGrid, 'painted', self.on_grid, LATCHED)
        self.create_subscription(OccupancyGrid, 'painted', self.on_volatile, 1)

    def on_volatile(self, _grid):
        self.got['volatile'] += 1

    def on_grid(self, grid):
        self.got['latched'] += 1
        values = list(grid.data)
        free, occupied = values.count(0), values.count(100)
        self.get_logger().info(
            f'{grid.info.width} x {grid.info.height}, free: {free > 50}, occupied: {occupied > 10}')


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    painter = Painter()
    executor.add_node(painter)
    while painter.published < 5:
        executor.spin_once(timeout_sec=0.1)
    reader = Reader()
    executor.add_node(reader)
    end = reader.get_clock().now().nanoseconds + 2_000_000_000
    while reader.get_clock().now().nanoseconds < end:
        executor.spin_once(timeout_sec=0.1)
    print(f"late reader: latched {reader.got['latched']}, volatile {reader.got['volatile']}")
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

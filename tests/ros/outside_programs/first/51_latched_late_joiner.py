#!/usr/bin/env python3
"""A latched topic: published once at the start, a subscriber that comes three seconds later still gets it,
and a volatile one does not."""
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSDurabilityPolicy, QoSReliabilityPolicy, QoSHistoryPolicy
from nav_msgs.msg import OccupancyGrid
from std_msgs.msg import String

LATCHED = QoSProfile(
    reliability=QoSReliabilityPolicy.RELIABLE,
    durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
    history=QoSHistoryPolicy.KEEP_LAST,
    depth=1)


class MapServer(Node):
    def __init__(self):
        super().__init__('map_server')
        self.map_pub = self.create_publisher(OccupancyGrid, 'map', LATCHED)
        grid = OccupancyGrid()
        grid.header.frame_id = 'map'
        grid.info.resolution = 0.05
        grid.info.width = 4
        grid.info.height = 3
        grid.info.origin.orientation.w = 1.0
        grid.data = [0, 0, 100, -1] * 3
        self.map_pub.publish(grid)
        self.get_logger().info('map published once')


class LateClient(Node):
    def __init__(self):
        super().__init__('late_client')
        self.got = {'latched': 0, 'volatile': 0}
        self.once = self.create_timer(3.0, self.join)

    def join(self):
        self.once.cancel()
        self.get_logger().info('joining now')
        self.s1 = self.create_subscription(OccupancyGrid, 'map', self.latched_cb, LATCHED)
        self.s2 = self.create_subscription(OccupancyGrid, 'map', self.volatile_cb, 1)
        self.judge = self.create_timer(2.0, self.verdict)

    def latched_cb(self, msg):
        self.got['latched'] += 1
        self.get_logger().info('map of %dx%d, %d occupied' % (msg.info.width, msg.info.height, list(msg.data).count(100)))

    def volatile_cb(self, msg):
        self.got['volatile'] += 1

    def verdict(self):
        self.judge.cancel()
        self.get_logger().info(f'latched {self.got["latched"]}, volatile {self.got["volatile"]}')
        rclpy.shutdown()


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    server, client = MapServer(), LateClient()
    executor.add_node(server)
    executor.add_node(client)
    try:
        executor.spin()
    except rclpy.executors.ExternalShutdownException:
        pass


if __name__ == '__main__':
    main()

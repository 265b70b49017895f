#!/usr/bin/env python3
"""Which subscriptions hear a best-effort and which a reliable publisher? A table."""
import itertools
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_system_default
from std_msgs.msg import UInt8

BE, RE = ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE


class Table(Node):
    def __init__(self):
        super().__init__('qos_table')
        self.count = {}
        self.pubs = {}
        for p in (BE, RE):
            topic = f'from_{p.name.lower()}'
            self.pubs[p] = self.create_publisher(UInt8, topic, QoSProfile(depth=10, reliability=p))
            for s in (BE, RE):
                key = (p.name, s.name)
                self.count[key] = 0
                self.create_subscription(UInt8, topic, lambda m, key=key: self.heard(key),
                                         QoSProfile(depth=10, reliability=s))
        self.ticks = 0
        self.timer = self.create_timer(0.1, self.tick)

    def heard(self, key):
        self.count[key] += 1

    def tick(self):
        self.ticks += 1
        if self.ticks <= 50:
            for pub in self.pubs.values():
                pub.publish(UInt8(data=self.ticks))
        elif self.ticks == 60:
            for (p, s), n in self.count.items():
                self.get_logger().info('%s -> %s: %s' % (p, s, 'nothing' if n == 0 else 'heard' if n > 25 else 'little'))
            raise SystemExit


def main():
    rclpy.init()
    table = Table()
    try:
        rclpy.spin(table)
    except SystemExit:
        table.get_logger().info('table complete')
    finally:
        table.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()

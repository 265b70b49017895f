#!/usr/bin/env python3
"""A health monitor: rates of topics, published as diagnostics each second."""
from collections import deque

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, LaserScan


class Health(Node):
    WANTED = {'odom': (Odometry, 40.0), 'scan': (LaserScan, 8.0), 'battery': (BatteryState, 0.5)}

    def __init__(self):
        super().__init__('health')
        self.heard = {}
        for topic, (kind, _) in self.WANTED.items():
            self.heard[topic] = deque(maxlen=200)
            self.create_subscription(kind, topic, lambda m, t=topic: self.heard[t].append(self.get_clock().now()),
                                     qos_profile_sensor_data)
        self.pub = self.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self.timer = self.create_timer(1.0, self.report)
        self.reports = 0

    def report(self):
        now = self.get_clock().now()
        array = DiagnosticArray()
        array.header.stamp = now.to_msg()
        for topic, (_, least) in self.WANTED.items():
            rate = sum((now - t).nanoseconds < 1_000_000_000 for t in self.heard[topic])
            status = DiagnosticStatus(name=f'{self.get_name()}: {topic}', hardware_id='sim')
            if not self.heard[topic]:
                status.level, status.message = DiagnosticStatus.STALE, 'nothing heard'
            elif rate < least:
                status.level, status.message = DiagnosticStatus.WARN, 'slow'
            else:
                status.level, status.message = DiagnosticStatus.OK, 'fine'
            status.values.append(KeyValue(key='rate', value=str(rate)))
            status.values.append(KeyValue(key='publishers', value=str(self.count_publishers(topic))))
            array.status.append(status)
        self.pub.publish(array)
        self.reports += 1
        if self.reports == 4:
            worst = max(array.status, key=lambda s: s.level)
            for s in array.status:
                self.get_logger().info(f'{s.name} {int.from_bytes(s.level, "little")} {s.message} '
                                       + ' '.join(f'{v.key}={v.value}' for v in s.values))
            print('worst', worst.message, flush=True)
            self.context.shutdown()


rclpy.init()
node = Health()
rclpy.get_default_context().on_shutdown(lambda: print('shutting down', flush=True))
try:
    rclpy.spin(node)
except rclpy.executors.ExternalShutdownException:
    pass

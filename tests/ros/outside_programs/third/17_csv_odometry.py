#!/usr/bin/env python3
"""Logs odometry to a CSV file and evaluates it afterwards: mean speed, percentile, distance."""
import csv
import os
import statistics
import tempfile
import threading
from datetime import datetime, timedelta
from pathlib import Path

import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry


class Logger(Node):
    def __init__(self, file):
        super().__init__('csv_logger')
        self.writer = csv.DictWriter(file, fieldnames=['t', 'x', 'y', 'v'])
        self.writer.writeheader()
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.sub = self.create_subscription(Odometry, 'odom', self.row, 50)
        self.tick = self.create_timer(0.1, self.command)
        self.t0 = datetime.now()

    def command(self):
        t = datetime.now() - self.t0
        msg = Twist()
        if t < timedelta(seconds=4):
            msg.linear.x = 0.4 if t < timedelta(seconds=2) else 0.2
        self.pub.publish(msg)

    def row(self, m):
        s = m.header.stamp
        self.writer.writerow({'t': f'{s.sec}.{s.nanosec:09d}', 'x': m.pose.pose.position.x,
                              'y': m.pose.pose.position.y, 'v': m.twist.twist.linear.x})


def main():
    rclpy.init()
    with tempfile.TemporaryDirectory(prefix='lab_') as folder:
        path = Path(folder) / 'odom.csv'
        with path.open('w', newline='') as f:
            node = Logger(f)
            stop = threading.Timer(5.0, rclpy.shutdown)
            stop.start()
            try:
                rclpy.spin(node)
            except rclpy.executors.ExternalShutdownException:
                pass
            stop.join(timeout=1.0)
        with open(path, newline='') as f:
            rows = list(csv.DictReader(f))
        print('bytes' if os.path.getsize(path) > 1000 else 'empty')
    v = [float(r['v']) for r in rows if float(r['v']) > 0.0]
    print(f'{len(rows)} rows, mean speed {statistics.mean(v):.2f}, median {statistics.median(v):.1f}')
    print(f"distance {float(rows[-1]['x']) - float(rows[0]['x']):.1f}")


if __name__ == '__main__':
    main()

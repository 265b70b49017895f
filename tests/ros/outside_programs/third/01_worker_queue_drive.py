#!/usr/bin/env python3
"""The scan callback only fills a queue, a worker thread takes the readings out and commands the robot."""
import queue
import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class QueueDriver(Node):
    def __init__(self):
        super().__init__('queue_driver')
        self.readings = queue.Queue(maxsize=5)
        self.stop = threading.Event()
        self.pub = self.create_publisher(Twist, 'cmd_vel', 1)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 5)
        self.worker = threading.Thread(target=self.work, name='worker')
        self.worker.start()

    def on_scan(self, msg):
        ahead = min(msg.ranges[:15] + msg.ranges[-15:])
        try:
            self.readings.put_nowait(ahead)
        except queue.Full:
            pass

    def work(self):
        handled = 0
        while not self.stop.is_set():
            try:
                d = self.readings.get(timeout=0.5)
            except queue.Empty:
                self.get_logger().warn('no scan for half a second')
                continue
            handled += 1
            t = Twist()
            # slow down over the last two metres, stop at one metre
            t.linear.x = max(0.0, min(0.5, 0.5 * (d - 1.0)))
            self.pub.publish(t)
            self.readings.task_done()
            if d < 1.05:
                break
        self.pub.publish(Twist())
        self.get_logger().info(f'worker done after {handled} readings')


def main():
    rclpy.init()
    node = QueueDriver()
    try:
        while rclpy.ok() and node.worker.is_alive():
            rclpy.spin_once(node, timeout_sec=0.1)
    finally:
        node.stop.set()
        node.worker.join(timeout=2.0)
        print('joined' if not node.worker.is_alive() else 'worker hangs')
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()

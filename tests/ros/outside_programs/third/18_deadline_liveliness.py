#!/usr/bin/env python3
"""Deadline events on both sides: a sensor stalls, the monitor hears of it and stops the robot."""
import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile
from geometry_msgs.msg import Twist
from std_msgs.msg import UInt32


class Sensor(Node):
    def __init__(self, qos):
        super().__init__('sensor')
        self.n = 0
        self.pub = self.create_publisher(UInt32, 'beat', qos, event_callbacks=PublisherEventCallbacks(
            deadline=lambda e: self.get_logger().warn(f'offered deadline missed, total {e.total_count}', once=True)))
        self.create_timer(0.2, self.beat)

    def beat(self):
        self.n += 1
        if 11 <= self.n <= 20:          # stalls for two seconds
            return
        self.pub.publish(UInt32(data=self.n))


class Monitor(Node):
    def __init__(self, qos):
        super().__init__('monitor')
        self.stalled = 0
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(UInt32, 'beat', self.on_beat, qos, event_callbacks=SubscriptionEventCallbacks(
            deadline=self.on_deadline))

    def on_beat(self, m):
        if self.stalled:
            self.get_logger().info(f'back with {m.data} after {self.stalled} missed deadlines')
            self.stalled = 0
        t = Twist()
        t.linear.x = 0.25
        self.cmd.publish(t)

    def on_deadline(self, event):
        if not self.stalled:
            self.get_logger().error('no heartbeat: stop')
        self.stalled += event.total_count_change
        self.cmd.publish(Twist())


def main():
    rclpy.init()
    qos = QoSProfile(depth=10, deadline=Duration(seconds=0.5))
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(Sensor(qos))
    executor.add_node(Monitor(qos))
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()

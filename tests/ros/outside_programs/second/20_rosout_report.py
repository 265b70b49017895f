#!/usr/bin/env python3
# counts what other nodes log (subscribes /rosout) and writes the report when the context goes down
import collections
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, DurabilityPolicy
from rcl_interfaces.msg import Log
from std_msgs.msg import String


class Report(Node):
    LEVELS = {int.from_bytes(v, 'little') if isinstance(v, bytes) else int(v): k for k, v in
              (('DEBUG', Log.DEBUG), ('INFO', Log.INFO), ('WARN', Log.WARN), ('ERROR', Log.ERROR), ('FATAL', Log.FATAL))}

    def __init__(self):
        super().__init__('report')
        self.counts = collections.Counter()
        qos = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(Log, '/rosout', self.on_log, qos)
        self.pub = self.create_publisher(String, 'report', 10)
        self.done = False
        self.create_timer(0.5, self.check)

    def on_log(self, log):
        if log.name != 'grumbler':
            return
        self.counts[self.LEVELS[log.level]] += 1
        if 'goodbye' in log.msg:
            self.done = True

    def bye(self):
        print('context is down', flush=True)

    def check(self):
        text = ' '.join(f'{k}={self.counts[k]}' for k in sorted(self.counts))
        self.pub.publish(String(data=text))
        if self.done:
            print('report:', text, flush=True)
            rclpy.shutdown()


def main():
    rclpy.init()
    report = Report()
    rclpy.get_default_context().on_shutdown(report.bye)     # must be a bound method
    rclpy.spin(report)


if __name__ == '__main__':
    main()

"""Timers that are steered: cancelled, reset, made faster, made late, one-shot, on another clock.

Meant: the counts that follow from the periods, and the timer's own times.
"""
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.node import Node


class Steered(Node):
    def __init__(self):
        super().__init__('steered')
        self.counts = {'slow': 0, 'once': 0, 'steady': 0, 'late': 0}
        self.slow = self.create_timer(1.0, self.on_slow)
        self.once = self.create_timer(0.3, self.on_once)
        self.steady = self.create_timer(
            0.5, self.on_steady, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self.late = self.create_timer(0.5, self.on_late, autostart=False)
        self.stamps = []

    def now(self):
        return self.get_clock().now().nanoseconds

    def on_slow(self):
        self.counts['slow'] += 1
        if self.counts['slow'] == 2:
            self.slow.timer_period_ns = 250_000_000
            self.get_logger().info(f'period {self.slow.timer_period_ns // 1_000_000} ms')
        if self.counts['slow'] == 3:
            self.late.reset()
        self.stamps.append(self.now())

    def on_once(self):
        self.counts['once'] += 1
        self.once.cancel()

    def on_steady(self):
        self.counts['steady'] += 1

    def on_late(self):
        self.counts['late'] += 1
        if self.counts['late'] == 2:
            self.destroy_timer(self.late)
            self.get_logger().info('late one destroyed')


def main():
    rclpy.init()
    node = Steered()
    print('late waits', node.late.is_canceled(), 'once waits', node.once.is_canceled())
    start = node.now()
    while node.now() - start < 5_050_000_000:
        rclpy.spin_once(node, timeout_sec=0.05)
    gaps = [round((b - a) / 1e9, 2) for a, b in zip(node.stamps, node.stamps[1:])]
    print('first gap', gaps[0], 'last gap', gaps[-1])
    print('once', node.counts['once'], node.once.is_canceled(), 'late', node.counts['late'])
    print('steady', node.counts['steady'] in (9, 10), 'timers', len(list(node.timers)))
    print('until next', 0 < node.slow.time_until_next_call() <= 250_000_000,
          'since last', 0 <= node.slow.time_since_last_call() < 250_000_000)
    node.once.reset()
    assert not node.once.is_ready()
    rclpy.spin_once(node, timeout_sec=0.0)
    end = node.now() + 400_000_000
    while node.now() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    print('once again', node.counts['once'])
    rclpy.shutdown()


if __name__ == '__main__':
    main()

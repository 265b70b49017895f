#!/usr/bin/env python3
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time


class Metronome(Node):
    """cancel, reset, change of period, guard condition, and some arithmetic with times"""

    def __init__(self):
        super().__init__('metronome')
        self.beats = 0
        self.metro = self.create_timer(0.2, self.beat)
        self.guard = self.create_guard_condition(self.on_guard)
        self.script = self.script_()
        self.director = self.create_timer(1.0, lambda: next(self.script))
        self.steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.t0 = self.steady.now()

    def beat(self):
        self.beats += 1

    def on_guard(self):
        self.get_logger().info('guard triggered')

    def count(self):
        n, self.beats = self.beats, 0
        return n

    def script_(self):
        log = self.get_logger()
        n = self.count()
        log.info(f'fast: {"ok" if 3 <= n <= 6 else n}')
        self.metro.cancel()
        yield
        log.info(f'cancelled: {self.count()}, {self.metro.is_canceled()}')
        self.metro.reset()
        self.metro.timer_period_ns = 500_000_000
        yield
        n = self.count()
        log.info(f'slow: {"ok" if 1 <= n <= 3 else n}, period {self.metro.timer_period_ns / 1e9}')
        self.guard.trigger()
        yield
        el = self.steady.now() - self.t0
        log.info(f'steady: {"ok" if Duration(seconds=3.5) < el < Duration(seconds=5) else el}')
        a = Time(seconds=10, nanoseconds=5)
        b = a + Duration(seconds=1, nanoseconds=500_000_000)
        s, ns = b.seconds_nanoseconds()
        log.info(f'{s} {ns} {a < b} {(b - a).nanoseconds} {Time.from_msg(b.to_msg()).nanoseconds == b.nanoseconds}')
        try:
            self.get_clock().now() < a
        except TypeError as e:
            log.info('clocks differ')
        raise SystemExit
        yield


def main():
    rclpy.init()
    node = Metronome()
    try:
        rclpy.spin(node)
    except SystemExit:
        pass
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()

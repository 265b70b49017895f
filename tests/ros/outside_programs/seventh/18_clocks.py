import threading
import time

import rclpy
from rclpy.clock import Clock, ClockType, ROSClock, JumpThreshold
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time


class Clocks(Node):
    def __init__(self):
        super().__init__('clocks')
        self.fired = []
        self.t = self.create_timer(0.1, self.on_t)
        self.steady = self.create_timer(0.25, lambda: self.fired.append('s'), clock=Clock(clock_type=ClockType.STEADY_TIME))

    def on_t(self):
        self.fired.append('t')
        if self.fired.count('t') == 5:
            self.t.cancel()
            self.get_logger().info(f'cancelled {self.t.is_canceled()}')


def main():
    rclpy.init()
    node = Clocks()
    spinner = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
    spinner.start()
    clock = node.get_clock()
    rate = node.create_rate(4)
    begin = clock.now()
    for _ in range(8):
        rate.sleep()
    took = clock.now() - begin
    print('eight at 4 Hz:', 1.7 <= took.nanoseconds / 1e9 <= 2.3)
    print('ticks', node.fired.count('t'), node.fired.count('s') >= 6)
    node.t.reset()
    woke = clock.sleep_for(Duration(seconds=0.35))
    print('after reset', node.fired.count('t'), woke)
    node.t.timer_period_ns = 50_000_000
    print('period', node.t.timer_period_ns)
    a = Time(seconds=5, nanoseconds=250_000_000, clock_type=ClockType.ROS_TIME)
    b = a + Duration(seconds=1.75)
    print(b.seconds_nanoseconds(), (b - a).nanoseconds, a < b, Time.from_msg(b.to_msg()) == b)
    try:
        print(a - Time(seconds=1))
    except TypeError as e:
        print('TypeError', e)
    print(Duration(seconds=-1.5).nanoseconds, Duration(nanoseconds=5).to_msg().nanosec, isinstance(clock, ROSClock))
    end = clock.now() + Duration(seconds=1)
    print('slept until', clock.sleep_until(end), clock.now() >= end)
    t0, w0 = time.monotonic(), clock.now()
    time.sleep(0.5)
    print('sleep and monotonic agree', abs((time.monotonic() - t0) - (clock.now() - w0).nanoseconds / 1e9) < 0.1)
    handle = clock.create_jump_callback(JumpThreshold(min_forward=Duration(seconds=10), min_backward=Duration(seconds=-1), on_clock_change=True),
                                        post_callback=lambda jump: print('jump'))
    handle.unregister()
    print('until next', 0 <= node.steady.time_until_next_call() <= 250_000_000)
    node.destroy_rate(rate)
    rclpy.shutdown()
    spinner.join(timeout=5)
    print('spinner ended', not spinner.is_alive())


if __name__ == '__main__':
    main()

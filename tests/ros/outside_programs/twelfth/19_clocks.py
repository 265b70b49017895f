"""Worksheet: times and durations, what may be compared and what not, timers that are turned off and on, rates, sleeping."""
import threading

import rclpy
from builtin_interfaces.msg import Duration as DurationMessage
from builtin_interfaces.msg import Time as TimeMessage
from rclpy.clock import Clock, ClockType, ROSClock
from rclpy.constants import S_TO_NS
from rclpy.duration import Duration, Infinite
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from rclpy.timer import Rate, Timer


def attempt(function):
    try:
        return function()
    except Exception as problem:
        return type(problem).__name__


def main():
    rclpy.init()
    node = Node('clocks')
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def wait(seconds):
        end = node.get_clock().now() + Duration(seconds=seconds)
        while node.get_clock().now() < end:
            executor.spin_once(timeout_sec=0.02)

    a, b = Time(seconds=2, nanoseconds=500), Time(seconds=3.5)
    print('difference', (b - a).nanoseconds, (a - b).nanoseconds, attempt(lambda: a + b))
    print('sum', (a + Duration(seconds=1)).seconds_nanoseconds(), a < b, a == Time(nanoseconds=2_000_000_500))
    print('clocks', attempt(lambda: a < Time(seconds=1, clock_type=ClockType.STEADY_TIME)),
          attempt(lambda: a - Time(seconds=1, clock_type=ClockType.ROS_TIME)))
    print('negative', attempt(lambda: Time(seconds=-1)), attempt(lambda: a - Duration(seconds=5)))
    print('message', Time.from_msg(TimeMessage(sec=1, nanosec=5), clock_type=ClockType.ROS_TIME).nanoseconds, b.to_msg())
    print('duration', Duration(seconds=-1.5).to_msg(), Duration.from_msg(DurationMessage(sec=2)).nanoseconds == 2 * S_TO_NS)
    print('durations', Duration(seconds=1) < Duration(nanoseconds=2 * S_TO_NS), Infinite > Duration(seconds=1e6),
          attempt(lambda: Duration(seconds=1) < 2))
    print('arithmetic', (Duration(seconds=2) + Duration(seconds=1)).nanoseconds, attempt(lambda: (Duration(seconds=3) * 2).nanoseconds))
    print('kinds', node.get_clock().clock_type.name, isinstance(node.get_clock(), ROSClock), Clock().clock_type.name)

    ticks = {'plain': 0, 'off': 0, 'once': 0, 'late': 0}

    def ticking(name):
        def tick():
            ticks[name] += 1
            if name == 'once':
                once.cancel()
        return tick

    plain = node.create_timer(0.1, ticking('plain'))
    off = node.create_timer(0.1, ticking('off'), autostart=False)
    once = node.create_timer(0.2, ticking('once'))
    print('timers', isinstance(plain, Timer), plain.timer_period_ns, off.is_canceled(), len(list(node.timers)))
    wait(0.55)
    print('first', ticks)
    off.reset()
    plain.timer_period_ns = int(0.05 * S_TO_NS)
    plain.reset()
    once.reset()
    wait(0.52)
    print('second', ticks, plain.is_ready(), 0 <= plain.time_until_next_call() <= 50_000_000)
    plain.cancel()
    print('cancelled', plain.is_canceled(), plain.time_until_next_call() is None or plain.time_until_next_call() > S_TO_NS,
          off.time_since_last_call() < 100_000_001)
    node.destroy_timer(off)
    wait(0.3)
    print('third', ticks, len(list(node.timers)))

    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    rate = node.create_rate(4)
    begun = node.get_clock().now()
    for _ in range(4):
        rate.sleep()
    took = (node.get_clock().now() - begun).nanoseconds / S_TO_NS
    print('rate', isinstance(rate, Rate), 0.9 <= took <= 1.1)
    begun = node.get_clock().now()
    print('slept', node.get_clock().sleep_for(Duration(seconds=0.5)),
          node.get_clock().sleep_until(begun + Duration(seconds=0.75)),
          f'{(node.get_clock().now() - begun).nanoseconds / S_TO_NS:.2f}')
    print('other clock', attempt(lambda: node.get_clock().sleep_until(Time(seconds=1, clock_type=ClockType.STEADY_TIME))))
    threading.Timer(0.3, rclpy.shutdown).start()
    print('woken', node.get_clock().sleep_for(Duration(seconds=30)), rclpy.ok())
    thread.join(timeout=2)


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
"""Worksheet on time: clocks, durations, arithmetic, sleeping until."""
import rclpy
from builtin_interfaces.msg import Duration as DurationMsg
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration, Infinite
from rclpy.node import Node
from rclpy.time import Time


def main():
    rclpy.init()
    node = Node('worksheet')
    clock = node.get_clock()
    print('1', clock.clock_type == ClockType.ROS_TIME, Clock().clock_type == ClockType.SYSTEM_TIME)
    a = Time(seconds=5, nanoseconds=250_000_000)
    b = a + Duration(seconds=1.5)
    print('2', b.seconds_nanoseconds(), (b - a).nanoseconds, b > a, a == Time(nanoseconds=a.nanoseconds))
    print('3', a.to_msg().sec, a.to_msg().nanosec, Time.from_msg(a.to_msg()) == Time(seconds=5.25, clock_type=ClockType.ROS_TIME))
    print('4', Duration.from_msg(DurationMsg(sec=2, nanosec=5)).nanoseconds, Duration(seconds=-0.5).to_msg().sec)
    try:
        Time(seconds=1, clock_type=ClockType.STEADY_TIME) < Time(seconds=1, clock_type=ClockType.ROS_TIME)
    except TypeError as error:
        print('5', type(error).__name__)
    try:
        Time(seconds=-1)
    except ValueError:
        print('6 no negative times')
    print('7', isinstance(a - Duration(seconds=1), Time), isinstance(b - a, Duration))
    start = clock.now()
    slept = clock.sleep_until(start + Duration(seconds=1.5))
    print('8', slept, round((clock.now() - start).nanoseconds * 1e-9, 1))
    clock.sleep_for(Duration(seconds=0.5))
    print('9', round((clock.now() - start).nanoseconds / 1e9, 1))
    steady = Clock(clock_type=ClockType.STEADY_TIME)
    first = steady.now()
    steady.sleep_for(Duration(seconds=0.25))
    print('10', (steady.now() - first) >= Duration(seconds=0.25))
    ticks = []
    timer = node.create_timer(0.25, lambda: ticks.append(clock.now()), clock=clock)
    while len(ticks) < 4:
        rclpy.spin_once(node)
    gaps = {round((y - x).nanoseconds * 1e-9, 2) for x, y in zip(ticks, ticks[1:])}
    print('11', gaps, timer.timer_period_ns, timer.is_ready(), timer.time_until_next_call() <= 250_000_000)
    print('12', Infinite.nanoseconds > 0, repr(Duration(seconds=1)))
    rate = node.create_rate(2)
    print('13', type(rate).__name__, hasattr(rate, 'sleep'))
    node.destroy_rate(rate)
    rclpy.shutdown()
    print('14', rclpy.ok(), flush=True)


main()

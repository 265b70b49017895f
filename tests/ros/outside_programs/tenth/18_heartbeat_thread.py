"""A thread with a rate, a guard condition that it triggers, wait_for_message, and an orderly end.

Meant: the thread beats at 5 Hz of the node's clock for three seconds while the main thread spins;
each beat triggers the guard; a second program part waits for one message; the thread ends when
the context is shut down.
"""
import threading

import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import UInt8


class Heart(Node):
    def __init__(self):
        super().__init__('heart')
        self.publisher = self.create_publisher(UInt8, 'beat', 10)
        self.guard = self.create_guard_condition(self.on_guard)
        self.rate = self.create_rate(5)
        self.beats = self.triggered = 0
        self.stamps = []
        self.ended = threading.Event()

    def on_guard(self):
        self.triggered += 1

    def run(self):
        try:
            while rclpy.ok():
                self.beats += 1
                self.stamps.append(self.get_clock().now().nanoseconds)
                self.publisher.publish(UInt8(data=self.beats % 256))
                self.guard.trigger()
                self.rate.sleep()
        except rclpy.exceptions.ROSInterruptException:
            pass
        self.ended.set()


def main():
    rclpy.init()
    heart = Heart()
    executor = MultiThreadedExecutor(2)
    executor.add_node(heart)
    thread = threading.Thread(target=heart.run, daemon=True)
    thread.start()
    spinner = threading.Thread(target=executor.spin, daemon=True)
    spinner.start()

    ear = rclpy.create_node('ear')
    found, message = wait_for_message(UInt8, ear, 'beat', time_to_wait=2.0)
    print('waited', found, type(message).__name__)
    nothing, _ = wait_for_message(UInt8, ear, 'silence', time_to_wait=0.5)
    print('silence', nothing)
    clock = ear.get_clock()
    clock.sleep_until(clock.now() + rclpy.duration.Duration(seconds=3))
    beats, guards = heart.beats, heart.triggered
    print('beats', 15 <= beats <= 21, 'guards', abs(beats - guards) <= 1)
    gaps = [b - a for a, b in zip(heart.stamps, heart.stamps[1:])]
    print('even', all(abs(gap - 200_000_000) < 20_000_000 for gap in gaps[1:]))
    executor.shutdown()
    rclpy.shutdown()
    print('thread ended', heart.ended.wait(2.0))
    spinner.join(2.0)
    print('spinner ended', not spinner.is_alive())


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
# how regular are timers? 10 Hz and 3 Hz beside a callback that sleeps 40 ms; plus a barrier at the end
import threading
import time
from statistics import mean, pstdev
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Jitter(Node):
    def __init__(self, barrier):
        super().__init__('jitter')
        self.barrier = barrier
        self.stamps = {10.0: [], 3.0: []}
        for hz in self.stamps:
            self.create_timer(1.0 / hz, lambda hz=hz: self.tick(hz), callback_group=MutuallyExclusiveCallbackGroup())

    def tick(self, hz):
        s = self.stamps[hz]
        s.append(time.monotonic_ns())
        if hz == 3.0:
            time.sleep(0.04)
        if len(s) == int(3 * hz):
            try:
                self.barrier.wait(timeout=2.0)
            except threading.BrokenBarrierError:
                self.get_logger().error('barrier broken')


def main():
    rclpy.init()
    barrier = threading.Barrier(3)
    node = Jitter(barrier)
    ex = MultiThreadedExecutor(num_threads=4)
    ex.add_node(node)
    t = threading.Thread(target=ex.spin, daemon=True)
    t.start()
    started = time.monotonic()
    barrier.wait(timeout=30)
    print(f'all there after {time.monotonic() - started:.1f} s')
    for hz, s in sorted(node.stamps.items()):
        gaps = [(b - a) * 1e-9 for a, b in zip(s, s[1:])]
        print(f'{hz:g} Hz: {len(s)} ticks, {mean(gaps):.3f} +- {pstdev(gaps):.2f} s')
    ex.shutdown(timeout_sec=2)
    rclpy.shutdown()


if __name__ == '__main__':
    main()

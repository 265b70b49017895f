#!/usr/bin/env python3
import queue
import threading

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Waker(Node):
    """A thread produces; a guard condition wakes the executor, which publishes."""

    def __init__(self):
        super().__init__('waker')
        self.inbox = queue.Queue()
        self.pub = self.create_publisher(String, 'words', 10)
        self.guard = self.create_guard_condition(self.on_wake)
        self.published = 0
        self.finished = rclpy.task.Future()
        self.thread = threading.Thread(target=self.produce)
        self.thread.start()

    def produce(self):
        clock = self.get_clock()
        for word in 'the quick brown fox jumps'.split():
            clock.sleep_for(rclpy.duration.Duration(seconds=0.5))
            self.inbox.put(word)
            self.guard.trigger()

    def on_wake(self):
        while True:
            try:
                word = self.inbox.get_nowait()
            except queue.Empty:
                return
            self.pub.publish(String(data=word))
            self.published += 1
            stamp = self.get_clock().now().nanoseconds / 1e9
            print(f'{word} at {stamp:.1f}', flush=True)
            if word == 'jumps':
                self.finished.set_result(self.published)


def main():
    with rclpy.init():
        node = Waker()
        rclpy.spin_until_future_complete(node, node.finished)
        node.thread.join()
        print('published', node.finished.result(), flush=True)
        node.destroy_guard_condition(node.guard)
        node.destroy_node()


main()

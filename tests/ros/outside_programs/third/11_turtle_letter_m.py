#!/usr/bin/env python3
"""Writes a capital M. The service calls are chained by done-callbacks, nothing ever waits."""
from collections import deque
from functools import partial
import rclpy
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.srv import SetPen, TeleportAbsolute


class Writer(Node):
    def __init__(self):
        super().__init__('letter_writer')
        self.pen = self.create_client(SetPen, '/turtle1/set_pen')
        self.teleport = self.create_client(TeleportAbsolute, '/turtle1/teleport_absolute')
        self.clear = self.create_client(Empty, '/clear')
        for c in (self.pen, self.teleport, self.clear):
            while not c.wait_for_service(timeout_sec=1.0):
                self.get_logger().info('service not available, waiting again...')
        up, down = SetPen.Request(off=1), SetPen.Request(r=200, g=20, b=20, width=6, off=0)
        P = TeleportAbsolute.Request
        self.jobs = deque([
            (self.pen, up), (self.teleport, P(x=3.0, y=2.0)), (self.clear, Empty.Request()), (self.pen, down),
            (self.teleport, P(x=3.0, y=8.0)), (self.teleport, P(x=5.5, y=5.0)), (self.teleport, P(x=8.0, y=8.0)),
            (self.teleport, P(x=8.0, y=2.0)), (self.pen, up), (self.teleport, P(x=9.0, y=1.0, theta=1.57)),
        ])
        self.total = len(self.jobs)
        self.next_job()

    def next_job(self, done=None, future=None):
        if future is not None and future.exception() is not None:
            self.get_logger().error(f'{done} failed: {future.exception()!r}')
        if not self.jobs:
            self.get_logger().info(f'{self.total} jobs done')
            raise SystemExit(0)
        client, request = self.jobs.popleft()
        client.call_async(request).add_done_callback(partial(self.next_job, client.srv_name))


def main(args=None):
    rclpy.init(args=args)
    writer = Writer()
    try:
        rclpy.spin(writer)
    finally:
        writer.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()

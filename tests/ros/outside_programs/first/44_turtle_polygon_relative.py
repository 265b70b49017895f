#!/usr/bin/env python3
import argparse
import math
import rclpy
from rclpy.node import Node
from turtlesim.srv import TeleportRelative


class Polygon(Node):
    def __init__(self, n, side):
        super().__init__('polygon')
        self.n, self.side = n, side
        self.cli = self.create_client(TeleportRelative, '/turtle1/teleport_relative')
        self.cli.wait_for_service()
        self.k = 0
        self.timer = self.create_timer(0.5, self.step)

    async def step(self):
        # async callback: await the service
        if self.k >= self.n:
            return
        self.k += 1
        k = self.k
        await self.cli.call_async(TeleportRelative.Request(linear=self.side, angular=0.0))
        await self.cli.call_async(TeleportRelative.Request(linear=0.0, angular=2 * math.pi / self.n))
        self.get_logger().info(f'side {k} of {self.n}')
        if k == self.n:
            self.get_logger().info('closed')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('n', type=int)
    parser.add_argument('-s', '--side', type=float, default=1.0)
    args, ros_args = parser.parse_known_args()
    rclpy.init(args=ros_args)
    rclpy.spin(Polygon(args.n, args.side))


if __name__ == '__main__':
    main()

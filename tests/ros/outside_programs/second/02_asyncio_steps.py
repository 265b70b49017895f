#!/usr/bin/env python3
# rclpy under asyncio: one task spins, another one tells the robot what to do
import asyncio
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


async def spin(node):
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0)
        await asyncio.sleep(0.005)


class Robot:
    def __init__(self, node: Node):
        self.cmd = Twist()
        self.pub = node.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = node.create_timer(0.1, lambda: self.pub.publish(self.cmd))
        self.log = node.get_logger()

    async def do(self, what, seconds, v=0.0, w=0.0):
        self.log.info(what)
        self.cmd.linear.x = v
        self.cmd.angular.z = w
        await asyncio.sleep(seconds)


async def mission(robot):
    await robot.do('out', 4, v=0.25)
    await robot.do('about turn', 4, w=0.785)
    await robot.do('home', 4, v=0.25)
    await robot.do('rest', 1)


async def run():
    node = rclpy.create_node('asyncio_robot')
    robot = Robot(node)
    spinner = asyncio.create_task(spin(node))
    await mission(robot)
    spinner.cancel()
    try:
        await spinner
    except asyncio.CancelledError:
        robot.log.info('mission accomplished')
    node.destroy_node()


if __name__ == '__main__':
    rclpy.init()
    asyncio.run(run())
    rclpy.shutdown()

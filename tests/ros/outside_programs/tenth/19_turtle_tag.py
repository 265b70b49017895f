"""Turtlesim tag: spawn two, teleport one, rotate by action, chase until caught, kill, look around.

Meant: as the beginner tutorials use turtlesim's services and its action, with async/await in one
coroutine that the executor runs.
"""
import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.node import Node
from std_srvs.srv import Empty
from turtlesim.action import RotateAbsolute
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, Spawn, TeleportAbsolute, TeleportRelative


class Tag(Node):
    def __init__(self):
        super().__init__('tag')
        self.poses = {}
        for name in ('turtle1', 'hare'):
            self.create_subscription(
                Pose, f'/{name}/pose', lambda pose, name=name: self.poses.update({name: pose}), 10)
        self.colours = []
        self.create_subscription(Color, '/turtle1/color_sensor', self.colours.append, 10)
        self.drive = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.caught = rclpy.task.Future()
        self.chasing = None

    async def call(self, kind, service, **fields):
        client = self.create_client(kind, service)
        if not client.wait_for_service(timeout_sec=5.0):
            raise RuntimeError(service)
        answer = await client.call_async(kind.Request(**fields))
        self.destroy_client(client)
        return answer

    async def pause(self, seconds):
        over = rclpy.task.Future()
        timer = self.create_timer(seconds, lambda: over.set_result(None) if not over.done() else None)
        await over
        self.destroy_timer(timer)

    async def play(self):
        answer = await self.call(Spawn, 'spawn', x=2.0, y=9.0, theta=0.0, name='hare')
        print('spawned', answer.name)
        answer = await self.call(Spawn, 'spawn', x=2.0, y=9.0, theta=0.0, name='hare')
        print('again', repr(answer.name))
        await self.call(TeleportAbsolute, 'hare/teleport_absolute', x=8.0, y=8.0, theta=0.0)
        await self.call(TeleportRelative, 'hare/teleport_relative', linear=1.0, angular=math.pi / 2)
        rotate = ActionClient(self, RotateAbsolute, 'turtle1/rotate_absolute')
        rotate.wait_for_server()
        handle = await rotate.send_goal_async(RotateAbsolute.Goal(theta=math.pi / 4))
        result = await handle.get_result_async()
        print('turned', handle.accepted, abs(abs(result.result.delta) - math.pi / 4) < 0.05)
        self.chasing = self.create_timer(0.1, self.chase)
        way = await self.caught
        print('caught', way < 0.3)
        await self.call(Kill, 'kill', name='hare')
        await self.call(Empty, 'clear')
        await self.pause(0.5)
        names = [name for name, _ in self.get_topic_names_and_types() if name.startswith('/turtle')]
        print('pose topics', sorted(n for n in names if n.endswith('pose')),
              'hare gone', self.count_publishers('/hare/pose') == 0)
        blue = self.colours[-1]
        print('background', (blue.r, blue.g, blue.b) in ((69, 86, 255),), len(self.colours) > 10)

    def chase(self):
        me, other = self.poses['turtle1'], self.poses['hare']
        dx, dy = other.x - me.x, other.y - me.y
        way = math.hypot(dx, dy)
        if way < 0.3:
            self.chasing.cancel()
            self.drive.publish(Twist())
            self.caught.set_result(way)
            return
        twist = Twist()
        twist.linear.x = min(2.0, 1.5 * way)
        twist.angular.z = 4.0 * math.remainder(math.atan2(dy, dx) - me.theta, math.tau)
        self.drive.publish(twist)


def main():
    rclpy.init()
    tag = Tag()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(tag)
    task = executor.create_task(tag.play())
    executor.spin_until_future_complete(task)
    task.result()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

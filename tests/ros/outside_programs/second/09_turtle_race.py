#!/usr/bin/env python3
import sys
import rclpy
from rclpy.node import Node
from rclpy.executors import SingleThreadedExecutor
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose
from turtlesim.srv import Spawn, TeleportAbsolute

FINISH = 9.5


class Runner(Node):
    """one node per turtle, in the turtle's own namespace"""

    def __init__(self, name, speed, referee):
        super().__init__('runner', namespace=name)
        self.turtle, self.speed, self.referee = name, speed, referee
        self.running = True
        self.cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Pose, 'pose', self.on_pose, 10)

    def on_pose(self, pose):
        t = Twist()
        if pose.x >= FINISH:
            if self.running:
                self.running = False
                self.referee.append(self.turtle)
                self.get_logger().info(f'finishes in place {len(self.referee)}')
        else:
            t.linear.x = self.speed
        self.cmd.publish(t)


def main():
    rclpy.init(args=sys.argv)
    organiser = rclpy.create_node('organiser')
    spawn = organiser.create_client(Spawn, 'spawn')
    teleport = organiser.create_client(TeleportAbsolute, 'turtle1/teleport_absolute')
    spawn.wait_for_service()
    teleport.wait_for_service()

    def wait(future):
        rclpy.spin_until_future_complete(organiser, future)
        return future.result()

    wait(teleport.call_async(TeleportAbsolute.Request(x=1.0, y=5.0, theta=0.0)))
    referee = []
    runners = [Runner('turtle1', 1.0, referee)]
    for name, y, speed in (('hare', 7.0, 2.0), ('tortoise', 3.0, 0.7)):
        got = wait(spawn.call_async(Spawn.Request(x=1.0, y=y, theta=0.0, name=name)))
        runners.append(Runner(got.name, speed, referee))

    executor = SingleThreadedExecutor()
    for r in runners:
        executor.add_node(r)
    while rclpy.ok() and len(referee) < len(runners):
        executor.spin_once(timeout_sec=0.5)
    organiser.get_logger().info('the winner is ' + referee[0])
    organiser.get_logger().info('order: ' + ' '.join(referee))
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

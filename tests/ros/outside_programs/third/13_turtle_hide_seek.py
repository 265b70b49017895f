#!/usr/bin/env python3
"""seek [name]: one node a turtle, both in this process; the hider flees when the seeker is close, the walls push back."""
import argparse
import math
import sys
import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose
from turtlesim.srv import Spawn


class Swimmer(Node):
    def __init__(self, turtle):
        super().__init__(turtle + '_driver')
        self.pose = None
        self.create_subscription(Pose, f'/{turtle}/pose', lambda p: setattr(self, 'pose', p), 10)
        self.pub = self.create_publisher(Twist, f'/{turtle}/cmd_vel', 10)

    def steer(self, fx, fy, limit):
        e = math.remainder(math.atan2(fy, fx) - self.pose.theta, 2 * math.pi)
        t = Twist()
        t.linear.x = min(limit, math.hypot(fx, fy)) * max(0.0, math.cos(e))
        t.angular.z = 5.0 * e
        self.pub.publish(t)


def main():
    parser = argparse.ArgumentParser(description='hide and seek')
    parser.add_argument('hider')
    parser.add_argument('-s', '--speed', type=float, default=1.5)
    opts = parser.parse_args(remove_ros_args(sys.argv)[1:])

    rclpy.init(args=sys.argv)
    boss = Node('boss')
    spawn = boss.create_client(Spawn, 'spawn')
    spawn.wait_for_service()
    f = spawn.call_async(Spawn.Request(x=8.0, y=8.0, name=opts.hider))
    rclpy.spin_until_future_complete(boss, f)
    boss.get_logger().info(f'hiding: {f.result().name}')

    seeker, hider = Swimmer('turtle1'), Swimmer(opts.hider)
    executor = rclpy.executors.SingleThreadedExecutor()
    for n in (boss, seeker, hider):
        executor.add_node(n)
    closest, end = math.inf, boss.get_clock().now() + rclpy.duration.Duration(seconds=20)
    while boss.get_clock().now() < end:
        executor.spin_once(timeout_sec=0.05)
        a, b = seeker.pose, hider.pose
        if a is None or b is None:
            continue
        dx, dy = b.x - a.x, b.y - a.y
        d = math.hypot(dx, dy)
        closest = min(closest, d)
        if d < 0.5:
            boss.get_logger().info('found')
            break
        seeker.steer(dx, dy, opts.speed)
        # flee, and keep away from the walls
        flee = 2.0 / max(d, 0.1) if d < 3.0 else 0.0
        wx = 1.0 / max(b.x, 0.1) ** 2 - 1.0 / max(11.0 - b.x, 0.1) ** 2
        wy = 1.0 / max(b.y, 0.1) ** 2 - 1.0 / max(11.0 - b.y, 0.1) ** 2
        hider.steer(flee * dx / d + wx, flee * dy / d + wy, 1.0)
    for n in (seeker, hider):
        n.pub.publish(Twist())
    print(f'closest {closest:.2f}')
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

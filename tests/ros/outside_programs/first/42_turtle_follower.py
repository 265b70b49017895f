#!/usr/bin/env python3
"""leader - follower: turtle1 swims a circle, a second turtle follows it at 1 m"""
import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose
from turtlesim.srv import Spawn


class Leader(Node):
    def __init__(self):
        super().__init__('leader')
        self.pub = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.create_timer(0.1, self.swim)

    def swim(self):
        t = Twist()
        t.linear.x, t.angular.z = 1.0, 0.5
        self.pub.publish(t)


class Follower(Node):
    def __init__(self):
        super().__init__('follower')
        self.poses = {}
        self.create_subscription(Pose, '/turtle1/pose', lambda m: self.store('turtle1', m), 10)
        self.create_subscription(Pose, '/follower/pose', lambda m: self.store('follower', m), 10)
        self.pub = self.create_publisher(Twist, '/follower/cmd_vel', 10)
        self.distances = []
        client = self.create_client(Spawn, '/spawn')
        client.wait_for_service()
        future = client.call_async(Spawn.Request(x=2.0, y=2.0, theta=0.0, name='follower'))
        rclpy.spin_until_future_complete(self, future)
        self.get_logger().info(future.result().name + ' spawned')
        self.create_timer(0.05, self.follow)
        self.create_timer(1.0, self.report)

    def store(self, name, msg):
        self.poses[name] = msg

    def follow(self):
        if len(self.poses) < 2:
            return
        a, b = self.poses['turtle1'], self.poses['follower']
        d = math.hypot(a.x - b.x, a.y - b.y)
        self.distances.append(d)
        ang = math.atan2(a.y - b.y, a.x - b.x) - b.theta
        ang = math.atan2(math.sin(ang), math.cos(ang))
        t = Twist()
        t.linear.x = max(0.0, 1.0 + 1.5 * (d - 1.0)) if d > 0.5 else 0.0
        t.angular.z = 4.0 * ang
        self.pub.publish(t)

    def report(self):
        if len(self.distances) > 300:
            last = self.distances[-100:]
            if max(last) < 1.6 and min(last) > 0.4:
                self.get_logger().info('formation held', once=True)


def main(args=None):
    rclpy.init(args=args)
    leader, follower = Leader(), Follower()
    executor = rclpy.executors.MultiThreadedExecutor()
    executor.add_node(leader)
    executor.add_node(follower)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        leader.destroy_node()
        follower.destroy_node()


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
import math
import random
from functools import partial

import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose
from turtlesim.srv import Kill, Spawn


class CatchThemAll(Node):
    """spawner and hunter in one node: three turtles, nearest first"""

    def __init__(self):
        super().__init__("catch_them_all")
        self.prey_ = {}
        self.pose_ = None
        self.busy_ = False
        self.caught_ = 0
        self.spawned_ = 0
        self.pub_ = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.sub_ = self.create_subscription(Pose, "turtle1/pose", self.callback_pose, 10)
        self.spawn_ = self.create_client(Spawn, "spawn")
        self.kill_ = self.create_client(Kill, "kill")
        self.spawn_timer_ = self.create_timer(1.0, self.spawn_one)
        self.control_timer_ = self.create_timer(0.02, self.control_loop)

    def callback_pose(self, msg):
        self.pose_ = msg

    def spawn_one(self):
        if self.spawned_ == 3:
            self.spawn_timer_.cancel()
            return
        if not self.spawn_.service_is_ready():
            return
        self.spawned_ += 1
        req = Spawn.Request()
        req.x = random.uniform(1.0, 10.0)
        req.y = random.uniform(1.0, 10.0)
        req.theta = random.uniform(0.0, 2 * math.pi)
        future = self.spawn_.call_async(req)
        future.add_done_callback(partial(self.callback_spawned, x=req.x, y=req.y))

    def callback_spawned(self, future, x, y):
        try:
            name = future.result().name
            self.prey_[name] = (x, y)
            self.get_logger().info(f"{name} is alive at ({x:.1f}, {y:.1f})")
        except Exception as e:
            self.get_logger().error("Service call failed %r" % (e,))

    def callback_killed(self, future, name):
        self.caught_ += 1
        self.get_logger().info(f"Caught {name}, {self.caught_} so far")
        self.busy_ = False
        if self.caught_ == 3:
            self.get_logger().info("Caught them all!")

    def control_loop(self):
        if self.pose_ is None or self.busy_ or not self.prey_:
            return
        name, (x, y) = min(self.prey_.items(),
                           key=lambda kv: math.hypot(kv[1][0] - self.pose_.x, kv[1][1] - self.pose_.y))
        dx, dy = x - self.pose_.x, y - self.pose_.y
        distance = math.hypot(dx, dy)
        msg = Twist()
        if distance > 0.5:
            msg.linear.x = 2 * distance
            diff = math.atan2(dy, dx) - self.pose_.theta
            if diff > math.pi:
                diff -= 2 * math.pi
            elif diff < -math.pi:
                diff += 2 * math.pi
            msg.angular.z = 6 * diff
        else:
            self.busy_ = True
            del self.prey_[name]
            future = self.kill_.call_async(Kill.Request(name=name))
            future.add_done_callback(partial(self.callback_killed, name=name))
        self.pub_.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = CatchThemAll()
    rclpy.spin(node)
    rclpy.shutdown()


if __name__ == "__main__":
    main()

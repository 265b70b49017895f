"""Tutorial: spawn turtles, catch each with turtle1 and kill it; services called from callbacks."""

import math
import random

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose
from turtlesim.srv import Kill, Spawn


class Catcher(Node):
    def __init__(self):
        super().__init__("turtle_catcher")
        self.declare_parameter("turtles", 3)
        self.alive = {}
        self.caught = []
        self.pose = None
        self.spawner = self.create_client(Spawn, "spawn")
        self.killer = self.create_client(Kill, "kill")
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 10)
        self.create_subscription(Pose, "turtle1/pose", self.on_pose, 10)
        while not self.spawner.wait_for_service(1.0):
            self.get_logger().warn("Waiting for the turtlesim server...")
        for _ in range(self.get_parameter("turtles").value):
            request = Spawn.Request()
            request.x, request.y = random.uniform(2.0, 9.0), random.uniform(2.0, 9.0)
            self.spawner.call_async(request).add_done_callback(
                lambda future, request=request: self.alive.update(
                    {future.result().name: (request.x, request.y)}
                )
            )
        self.create_timer(0.02, self.control)

    def on_pose(self, pose):
        self.pose = pose

    def control(self):
        if self.pose is None or not self.alive:
            return
        name, (x, y) = min(
            self.alive.items(), key=lambda item: math.dist(item[1], (self.pose.x, self.pose.y))
        )
        distance = math.dist((x, y), (self.pose.x, self.pose.y))
        command = Twist()
        if distance > 0.5:
            heading = math.atan2(y - self.pose.y, x - self.pose.x)
            command.linear.x = 2.0 * distance
            command.angular.z = 6.0 * math.remainder(heading - self.pose.theta, 2 * math.pi)
        else:
            del self.alive[name]
            self.caught.append(name)
            self.killer.call_async(Kill.Request(name=name))
        self.publisher.publish(command)


def main():
    rclpy.init()
    node = Catcher()
    while len(node.caught) < node.get_parameter("turtles").value:
        rclpy.spin_once(node)
    print("caught", *sorted(node.caught))


if __name__ == "__main__":
    main()

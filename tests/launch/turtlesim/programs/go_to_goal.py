"""Tutorial: ask for a goal, drive there with a proportional controller, say that it was reached."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Pose


class GoToGoal(Node):
    def __init__(self):
        super().__init__("go_to_goal")
        self.pose = None
        self.create_subscription(Pose, "/turtle1/pose", self.on_pose, 10)
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)

    def on_pose(self, pose):
        self.pose = pose

    def drive_to(self, x, y):
        while rclpy.ok():
            rclpy.spin_once(self)
            if self.pose is None:
                continue
            command = Twist()
            distance = math.hypot(x - self.pose.x, y - self.pose.y)
            if distance < 0.1:
                self.publisher.publish(command)
                return
            heading = math.atan2(y - self.pose.y, x - self.pose.x)
            command.linear.x = 1.5 * distance
            command.angular.z = 6.0 * math.remainder(heading - self.pose.theta, 2 * math.pi)
            self.publisher.publish(command)


def main():
    rclpy.init()
    node = GoToGoal()
    x = float(input("Set your x goal: "))
    y = float(input("Set your y goal: "))
    node.drive_to(x, y)
    print(f"reached {node.pose.x:.1f} {node.pose.y:.1f}")
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()

"""A turner that turns the robot when it is asked to, and a captain that
asks, waits, and then drives."""

import math
import time

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from tf_transformations import euler_from_quaternion
from turtlesim.action import RotateAbsolute


class Captain(Node):
    """Asks for a turn to the west, and drives when it is done. Your work
    is here."""

    def __init__(self):
        super().__init__("captain")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.client = ActionClient(self, RotateAbsolute, "turn_to")
        self.is_turned = False
        self.create_timer(0.1, self.go)
        self.start = self.create_timer(0.2, self.ask)

    def ask(self):
        """Called once, after 0.2 s."""
        self.start.cancel()
        goal = RotateAbsolute.Goal(theta=math.pi)
        # TODO: send the goal, and have on_answer called when the server
        # has answered

    def on_answer(self, future):
        """The server has said yes or no."""
        handle = future.result()
        # TODO: if it said yes, ask for the result, and have on_result
        # called when it is there

    def on_result(self, future):
        """The turn has ended, well or not."""
        # TODO: self.is_turned = True, but only if it succeeded

    def go(self):
        if self.is_turned:
            command = Twist()
            command.linear.x = 0.3
            self.drive.publish(command)


class Turner(Node):
    """The server of the action turn_to. It is complete: leave it as it
    is."""

    def __init__(self):
        super().__init__("turner")
        self.mood = self.declare_parameter("mood", "willing").value
        self.heading = 0.0
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)
        self.server = ActionServer(
            self,
            RotateAbsolute,
            "turn_to",
            self.execute,
            goal_callback=self.on_goal,
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def on_odom(self, odom):
        q = odom.pose.pose.orientation
        self.heading = euler_from_quaternion([q.x, q.y, q.z, q.w])[2]

    def on_goal(self, goal):
        return GoalResponse.REJECT if self.mood == "unwilling" else GoalResponse.ACCEPT

    def execute(self, handle):
        began = self.heading
        left = math.remainder(handle.request.theta - self.heading, 2 * math.pi)
        while abs(left) > 0.03:
            if self.mood == "weary":
                self.turn(0.0)
                handle.abort()
                return RotateAbsolute.Result(delta=0.0)
            self.turn(math.copysign(min(0.8, 2 * abs(left)), left))
            handle.publish_feedback(RotateAbsolute.Feedback(remaining=left))
            time.sleep(0.05)
            left = math.remainder(handle.request.theta - self.heading, 2 * math.pi)
        self.turn(0.0)
        handle.succeed()
        return RotateAbsolute.Result(delta=math.remainder(self.heading - began, 2 * math.pi))

    def turn(self, rate):
        command = Twist()
        command.angular.z = rate
        self.drive.publish(command)


def main(args=None):
    rclpy.init(args=args)
    executor = MultiThreadedExecutor()
    executor.add_node(Turner())
    executor.add_node(Captain())
    executor.spin()


if __name__ == "__main__":
    main()

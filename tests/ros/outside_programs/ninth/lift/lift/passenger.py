import sys

import rclpy
from rclpy.action import ActionClient
from rclpy.action.client import ClientGoalHandle, GoalStatus
from rclpy.node import Node

from lift_interfaces.action import Ride
from lift_interfaces.msg import LiftState, Stop
from lift_interfaces.srv import CallLift


class Passenger(Node):
    def __init__(self):
        super().__init__("passenger")
        self.declare_parameter("floor", 2)
        self.call = self.create_client(CallLift, "/lift/call")
        self.rides = ActionClient(self, Ride, "/lift/ride")
        self.heights = []
        self.create_subscription(LiftState, "/lift/state", lambda m: self.heights.append(m.height), 10)

    def wait(self, future):
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def run(self):
        self.call.wait_for_service()
        self.rides.wait_for_server()
        answer = self.wait(self.call.call_async(CallLift.Request(floor=12)))
        self.get_logger().info(f"{answer.accepted} {answer.problem == CallLift.Request.UNKNOWN_FLOOR} {answer.message}")
        default = Stop()
        state = LiftState()
        self.get_logger().info(f"{default.label} {list(state.doors)} {LiftState.UP} {Stop.get_fields_and_field_types()}")
        try:
            Stop(label="much too long")
        except AssertionError as error:
            self.get_logger().info(f"refused: {'8' in str(error)}")
        floor = self.get_parameter("floor").value
        handle: ClientGoalHandle = self.wait(
            self.rides.send_goal_async(Ride.Goal(target=Stop(floor=floor)), feedback_callback=self.on_feedback)
        )
        result = self.wait(handle.get_result_async())
        self.get_logger().info(
            f"status {result.status == GoalStatus.STATUS_SUCCEEDED}, {result.result.seconds:.1f} s, "
            f"passed {list(result.result.passed)}, top {max(self.heights):.1f}"
        )
        handle = self.wait(self.rides.send_goal_async(Ride.Goal(target=Stop(floor=0))))
        self.wait_s(1.0)
        self.wait(handle.cancel_goal_async())
        result = self.wait(handle.get_result_async())
        self.get_logger().info(f"status {result.status}, {len(result.result.passed)}")
        return 0

    def on_feedback(self, message):
        self.feedback = message.feedback.height

    def wait_s(self, seconds):
        end = self.get_clock().now() + rclpy.duration.Duration(seconds=seconds)
        while self.get_clock().now() < end:
            rclpy.spin_once(self, timeout_sec=0.1)


def main(args=None):
    rclpy.init(args=args)
    node = Passenger()
    try:
        sys.exit(node.run())
    finally:
        node.destroy_node()
        rclpy.try_shutdown()

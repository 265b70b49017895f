import asyncio

import rclpy
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node

from lift_interfaces.action import Ride
from lift_interfaces.msg import LiftState, Stop
from lift_interfaces.srv import CallLift

from .heights import FLOOR_HEIGHT, floor_of


class Lift(Node):
    def __init__(self):
        super().__init__("lift")
        group = ReentrantCallbackGroup()
        self.state = LiftState()
        self.pub = self.create_publisher(LiftState, "~/state", 10)
        self.create_service(CallLift, "~/call", self.on_call, callback_group=group)
        self.server = ActionServer(
            self,
            Ride,
            "~/ride",
            self.ride,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
            callback_group=group,
        )
        self.create_timer(0.1, self.move, callback_group=group)
        self.waiting = []

    def on_call(self, request, response):
        if request.floor > Stop.MAX_FLOOR:
            response.problem = CallLift.Request.UNKNOWN_FLOOR
            response.message = f"{LiftState.NAME} stops at floors to {Stop.MAX_FLOOR}"
            return response
        self.add(request.floor)
        response.accepted = True
        return response

    def add(self, floor):
        if all(stop.floor != floor for stop in self.state.stops):
            self.state.stops.append(Stop(floor=floor, label=f"floor {floor}"))

    def move(self):
        state = self.state
        if state.stops:
            goal = state.stops[0].floor * FLOOR_HEIGHT
            away = goal - state.height
            if abs(away) < 0.05:
                state.stops.pop(0)
                state.direction = LiftState.RESTING
            else:
                state.direction = LiftState.UP if away > 0 else LiftState.DOWN
                state.height += state.direction * min(0.3, abs(away))
        state.stamp = self.get_clock().now().to_msg()
        self.pub.publish(state)

    async def ride(self, goal):
        begin = self.get_clock().now()
        self.add(goal.request.target.floor)
        passed = []
        while abs(self.state.height - goal.request.target.floor * FLOOR_HEIGHT) > 0.05:
            if goal.is_cancel_requested:
                self.state.stops.clear()
                goal.canceled()
                return Ride.Result(passed=passed)
            floor = floor_of(self.state.height)
            if floor not in passed:
                passed.append(floor)
            goal.publish_feedback(Ride.Feedback(height=self.state.height))
            future = rclpy.task.Future()
            timer = self.create_timer(0.2, lambda: future.set_result(None) if not future.done() else None)
            await future
            self.destroy_timer(timer)
        goal.succeed()
        took = (self.get_clock().now() - begin).nanoseconds / 1e9
        return Ride.Result(seconds=took, passed=passed)


def main(args=None):
    rclpy.init(args=args)
    node = Lift()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass

"""Four deliveries at once by one action server: one arrives, one is refused, one breaks down, one may not be cancelled, one may."""
import time

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Point
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse, get_action_names_and_types
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from shop_interfaces.action import Deliver
from shop_interfaces.msg import Basket

NAMES = {getattr(GoalStatus, name): name[7:] for name in dir(GoalStatus) if name.startswith('STATUS_')}


class Courier(Node):
    def __init__(self):
        super().__init__('courier')
        self.server = ActionServer(
            self, Deliver, 'deliver',
            execute_callback=self.execute,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
            callback_group=ReentrantCallbackGroup(),
        )
        self.at_once = self.most = 0

    def on_goal(self, goal: Deliver.Goal):
        return GoalResponse.REJECT if goal.to.x > 100.0 else GoalResponse.ACCEPT

    def on_cancel(self, goal_handle):
        return CancelResponse.REJECT if goal_handle.request.basket.owner == 'doctor' else CancelResponse.ACCEPT

    def execute(self, goal_handle):
        self.at_once += 1
        self.most = max(self.most, self.at_once)
        result, feedback = Deliver.Result(), Deliver.Feedback()
        try:
            while result.way < goal_handle.request.to.x:
                if goal_handle.is_cancel_requested:
                    goal_handle.canceled()
                    return result
                if goal_handle.request.basket.owner == 'unlucky' and result.steps == 3:
                    goal_handle.abort()
                    return result
                time.sleep(0.1)
                result.way += 1.0
                result.steps += 1
                feedback.remaining = goal_handle.request.to.x - result.way
                goal_handle.publish_feedback(feedback)
            goal_handle.succeed()
            return result
        finally:
            self.at_once -= 1


class Sender(Node):
    def __init__(self):
        super().__init__('sender')
        self.client = ActionClient(self, Deliver, 'deliver')
        self.told, self.handles, self.feedback = {}, {}, {}

    def send(self, owner, distance):
        goal = Deliver.Goal(basket=Basket(owner=owner), to=Point(x=distance))
        future = self.client.send_goal_async(
            goal, feedback_callback=lambda message: self.feedback.setdefault(owner, []).append(message.feedback.remaining))
        future.add_done_callback(lambda future: self.on_answer(owner, future.result()))

    def on_answer(self, owner, handle):
        if not handle.accepted:
            self.told[owner] = 'refused'
            return
        self.handles[owner] = handle
        handle.get_result_async().add_done_callback(lambda future: self.on_result(owner, future.result()))

    def on_result(self, owner, answer):
        self.told[owner] = f'{NAMES[answer.status]} {answer.result.way:.0f} {answer.result.steps}'

    def cancel(self, owner):
        return self.handles[owner].cancel_goal_async()


def main(args=None):
    rclpy.init(args=args)
    courier, sender = Courier(), Sender()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(courier)
    executor.add_node(sender)
    assert sender.client.wait_for_server(timeout_sec=5.0)
    print('actions', get_action_names_and_types(sender))
    for owner, distance in (('ana', 8.0), ('far', 200.0), ('unlucky', 9.0), ('doctor', 10.0), ('late', 50.0)):
        sender.send(owner, distance)
    begun = sender.get_clock().now()
    asked = {}
    while rclpy.ok() and len(sender.told) < 5:
        executor.spin_once(timeout_sec=0.05)
        waited = (sender.get_clock().now() - begun).nanoseconds / 1e9
        if waited > 0.55 and not asked and len(sender.handles) == 4:
            asked = {owner: sender.cancel(owner) for owner in ('doctor', 'late')}
    print('cancelling', *(f'{owner}: {len(future.result().goals_canceling)}' for owner, future in asked.items()))
    for owner in sorted(sender.told):
        print(owner, sender.told[owner])
    print('feedback', sender.feedback['ana'])
    print('at once', courier.most)
    courier.server.destroy()
    print('still there:', sender.client.wait_for_server(timeout_sec=0.5))
    rclpy.shutdown()


if __name__ == '__main__':
    main()

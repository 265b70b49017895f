import rclpy
from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from course_interfaces.action import CountDown
from rclpy.action import ActionClient
from rclpy.node import Node

NAMES = {
    GoalStatus.STATUS_SUCCEEDED: 'SUCCEEDED',
    GoalStatus.STATUS_CANCELED: 'CANCELED',
    GoalStatus.STATUS_ABORTED: 'ABORTED',
}


class Caller(Node):
    def __init__(self):
        super().__init__('count_down_client')
        self.client = ActionClient(self, CountDown, 'count_down')
        if not self.client.wait_for_server(timeout_sec=5.0):
            raise RuntimeError('no server')

    def finish(self, future, timeout=None):
        rclpy.spin_until_future_complete(self, future, timeout_sec=timeout)
        return future.result() if future.done() else None

    def send(self, start, period=0.5, feedback=None):
        return self.finish(self.client.send_goal_async(
            CountDown.Goal(start=start, period=period), feedback_callback=feedback))

    def tell(self, name, wrapped):
        print(f'{name} ended {NAMES[wrapped.status]} at {wrapped.result.reached}', flush=True)


def main():
    rclpy.init()
    caller = Caller()
    print('negative accepted:', caller.send(-3).accepted)
    first = caller.send(10)
    first_result = first.get_result_async()
    assert caller.finish(first_result, timeout=1.75) is None
    second = caller.send(20)
    caller.tell('first', caller.finish(first_result))
    second_result = second.get_result_async()
    caller.finish(second_result, timeout=1.0)
    answer = caller.finish(second.cancel_goal_async())
    assert answer.return_code == CancelGoal.Response.ERROR_NONE
    print('second cancel code', answer.return_code, 'cancelling', len(answer.goals_canceling))
    caller.tell('second', caller.finish(second_result))
    seen = []
    third = caller.send(3, 0.2, lambda msg: seen.append(msg.feedback.remaining))
    caller.tell('third', caller.finish(third.get_result_async()))
    print('feedback of third', seen)
    caller.client.destroy()
    caller.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

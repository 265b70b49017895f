import rclpy
from action_msgs.msg import GoalStatus
from drive_interfaces.action import DriveDistance
from rclpy.action import ActionClient
from rclpy.node import Node

STATUS = {GoalStatus.STATUS_SUCCEEDED: 'SUCCEEDED', GoalStatus.STATUS_CANCELED: 'CANCELED', GoalStatus.STATUS_ABORTED: 'ABORTED'}


class Client(Node):
    def __init__(self):
        super().__init__('drive_client')
        self.client = ActionClient(self, DriveDistance, 'drive_distance')
        self.feedbacks = 0

    def send(self, wait=True, **goal):
        self.client.wait_for_server()
        future = self.client.send_goal_async(DriveDistance.Goal(**goal), feedback_callback=self.on_feedback)
        rclpy.spin_until_future_complete(self, future)
        handle = future.result()
        if not handle.accepted:
            self.get_logger().info('goal rejected')
        return handle

    def on_feedback(self, msg):
        self.feedbacks += 1
        self.get_logger().info(f'{msg.feedback.remaining:.2f} m to go', throttle_duration_sec=1.0)

    def result(self, handle):
        future = handle.get_result_async()
        rclpy.spin_until_future_complete(self, future)
        r = future.result()
        self.get_logger().info(f'{STATUS[r.status]} driven {r.result.driven:.1f} complete {r.result.complete}')


def main():
    rclpy.init()
    c = Client()
    c.send(distance=9.0)
    c.result(c.send(distance=-0.4))
    long = c.send(distance=4.0, speed=0.1)
    rclpy.spin_until_future_complete(c, rclpy.Future(), timeout_sec=3.0)
    cancel = long.cancel_goal_async()
    rclpy.spin_until_future_complete(c, cancel)
    c.get_logger().info(f'cancelling {len(cancel.result().goals_canceling)} goal')
    c.result(long)
    c.get_logger().info('feedback came' if c.feedbacks > 20 else f'only {c.feedbacks} feedbacks')
    rclpy.shutdown()

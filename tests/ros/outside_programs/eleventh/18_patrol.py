import rclpy
from action_msgs.msg import GoalStatus
from course_interfaces.action import Patrol
from geometry_msgs.msg import Pose, PoseArray
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient
from rclpy.action.client import ClientGoalHandle
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message


class PatrolClient(Node):
    def __init__(self):
        super().__init__('patrol_client')
        self.client = ActionClient(self, Patrol, 'patrol')
        self.goal_handle: ClientGoalHandle = None
        self.current = None
        self.cancelled = False

    def send(self, corners):
        goal = Patrol.Goal()
        goal.goals = PoseArray(poses=[Pose() for _ in corners])
        goal.goals.header.frame_id = 'odom'
        for pose, (x, y) in zip(goal.goals.poses, corners):
            pose.position.x, pose.position.y = x, y
        self.client.wait_for_server()
        self.client.send_goal_async(goal, feedback_callback=self.on_feedback).add_done_callback(self.on_response)

    def on_response(self, future):
        self.goal_handle = future.result()
        if not self.goal_handle.accepted:
            raise SystemExit('rejected')
        print('goal accepted')
        self.goal_handle.get_result_async().add_done_callback(self.on_result)

    def on_feedback(self, message):
        feedback = message.feedback
        if feedback.current != self.current:
            self.current = feedback.current
            word = ', cancel' if self.current == 2 else ''
            print(f'towards {self.current}{word}')
        if self.current == 2 and not self.cancelled and feedback.distance_remaining < 1.0:
            self.cancelled = True
            self.goal_handle.cancel_goal_async()

    def on_result(self, future):
        answer = future.result()
        word = 'CANCELED' if answer.status == GoalStatus.STATUS_CANCELED else answer.status
        print(f'result {word}, missed {list(answer.result.missed)}')
        self.create_timer(0.5, self.check)

    def check(self):
        found, odom = wait_for_message(Odometry, self, '/odom', time_to_wait=1.0)
        print('standing:', found and abs(odom.twist.twist.linear.x) < 0.01)
        raise SystemExit


def main(args=None):
    rclpy.init(args=args)
    client = PatrolClient()
    client.send([(1.5, 0.0), (1.5, 1.5), (0.0, 1.5), (0.0, 0.0)])
    try:
        rclpy.spin(client)
    except SystemExit:
        pass
    rclpy.shutdown()


if __name__ == '__main__':
    main()

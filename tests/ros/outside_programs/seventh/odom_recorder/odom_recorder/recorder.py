import asyncio  # noqa: F401
import math

import rclpy
from nav_msgs.msg import Odometry
from odom_recorder_interfaces.action import OdomRecord
from odom_recorder_interfaces.msg import OdomSample
from rclpy.action import ActionServer
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from tf_transformations import euler_from_quaternion


class Recorder(Node):
    def __init__(self):
        super().__init__('odom_recorder')
        self.last = None
        self.total = 0.0
        self.create_subscription(Odometry, '/odom', self.on_odom, 10)
        self._server = ActionServer(self, OdomRecord, 'record_odom', self.execute)

    def on_odom(self, msg: Odometry):
        if self.last is not None:
            a, b = self.last.pose.pose.position, msg.pose.pose.position
            self.total += math.dist((a.x, a.y), (b.x, b.y))
        self.last = msg

    def execute(self, goal_handle):
        rate = self.create_rate(1)
        result = OdomRecord.Result()
        begin = self.total
        while self.total - begin < goal_handle.request.lap_length:
            if self.last is not None:
                q = self.last.pose.pose.orientation
                s = OdomSample(header=self.last.header)
                if not result.list_of_odoms:
                    s.kind = OdomSample.KIND_START
                s.position.x = self.last.pose.pose.position.x
                s.position.y = self.last.pose.pose.position.y
                s.yaw = euler_from_quaternion([q.x, q.y, q.z, q.w])[2]
                result.list_of_odoms.append(s)
            goal_handle.publish_feedback(OdomRecord.Feedback(current_total=self.total - begin))
            rate.sleep()
        goal_handle.succeed()
        return result


def main(args=None):
    rclpy.init(args=args)
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(Recorder())
    executor.spin()

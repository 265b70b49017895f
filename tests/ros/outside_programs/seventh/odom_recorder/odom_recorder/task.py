import rclpy
from odom_recorder_interfaces.action import OdomRecord
from odom_recorder_interfaces.msg import OdomSample
from rclpy.action import ActionClient
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from std_srvs.srv import SetBool


class Task(Node):
    def __init__(self):
        super().__init__('task')
        group = ReentrantCallbackGroup()      # its coroutine awaits answers
        self.moving = self.create_client(SetBool, 'moving', callback_group=group)
        self.record = ActionClient(self, OdomRecord, 'record_odom', callback_group=group)
        self.executor_task = None
        self.once = self.create_timer(0.1, self.run)

    async def run(self):
        self.once.cancel()
        self.moving.wait_for_service()
        self.record.wait_for_server()
        answer = await self.moving.call_async(SetBool.Request(data=True))
        self.get_logger().info(answer.message)
        handle = await self.record.send_goal_async(OdomRecord.Goal(lap_length=1.0))
        result = (await handle.get_result_async()).result
        samples = result.list_of_odoms
        answer = await self.moving.call_async(SetBool.Request(data=False))
        self.get_logger().info(answer.message)
        self.get_logger().info(f'{len(samples)} samples, first start: {samples[0].kind == OdomSample.KIND_START}, '
                               f'others way: {all(s.kind == s.KIND_WAY for s in samples[1:])}')
        stamps = [s.header.stamp.sec + s.header.stamp.nanosec * 1e-9 for s in samples]
        gaps = [b - a for a, b in zip(stamps, stamps[1:])]
        self.get_logger().info('one a second' if all(0.9 < g < 1.1 for g in gaps) else f'gaps {gaps}')
        raise SystemExit(0)


def main():
    rclpy.init()
    rclpy.spin(Task())

import rclpy
from lifecycle_msgs.msg import TransitionEvent
from lifecycle_msgs.srv import GetState
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from std_msgs.msg import Float64


class Listener(Node):
    def __init__(self):
        super().__init__('listener')
        self.values = []
        self.create_subscription(Float64, 'temperature', lambda m: self.values.append(m.data), 10)
        self.create_subscription(
            TransitionEvent, 'thermometer/transition_event', self.on_event, 10)
        self.client = self.create_client(
            GetState, 'thermometer/get_state', callback_group=ReentrantCallbackGroup())
        self.create_timer(1.0, self.ask)

    def on_event(self, event):
        self.get_logger().info(f'{event.start_state.label} -> {event.goal_state.label}')

    async def ask(self):
        if self.client.service_is_ready():
            answer = await self.client.call_async(GetState.Request())
            self.get_logger().info(f'state {answer.current_state.label}, heard {len(self.values)}')


def main():
    rclpy.init()
    try:
        rclpy.spin(Listener())
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass

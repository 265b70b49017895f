from typing import Optional

import rclpy
from lifecycle_msgs.msg import State
from rclpy.lifecycle import Node, Publisher
from rclpy.lifecycle import State as LifecycleState
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.timer import Timer
from std_msgs.msg import Float64


class Oven(Node):
    def __init__(self, **kwargs):
        self._pub: Optional[Publisher] = None
        self._timer: Optional[Timer] = None
        super().__init__('oven', **kwargs)
        self.declare_parameter('rate', 1.0)
        self.declare_parameter('start', 0.0)
        self.declare_parameter('target', 100.0)
        self.declare_parameter('use_gas', True)

    def heat(self):
        if self._pub is None or not self._pub.is_activated:
            return
        self.temperature = min(self.temperature + 2.0, self.get_parameter('target').value)
        self._pub.publish(Float64(data=self.temperature))

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.temperature = self.get_parameter('start').value
        self._pub = self.create_lifecycle_publisher(Float64, '~/heat', 10)
        self._timer = self.create_timer(1 / self.get_parameter('rate').value, self.heat)
        self.get_logger().info(f'configured from {state.label} at {self.temperature} gas {self.get_parameter("use_gas").value}')
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        assert state.state_id == State.PRIMARY_STATE_INACTIVE
        self.get_logger().info('flames on')
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.get_logger().info(f'flames off at {self.temperature}')
        return super().on_deactivate(state)

    def on_shutdown(self, state):
        self.destroy_timer(self._timer)
        self.destroy_publisher(self._pub)
        return TransitionCallbackReturn.SUCCESS


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    oven = Oven()
    executor.add_node(oven)
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        oven.destroy_node()

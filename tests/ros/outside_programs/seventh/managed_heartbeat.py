from typing import Optional

import rclpy
from rclpy.lifecycle import LifecycleNode, LifecycleState, Publisher, TransitionCallbackReturn
from rclpy.timer import Timer
from std_msgs.msg import UInt32


class Heartbeat(LifecycleNode):
    def __init__(self, **kwargs):
        super().__init__('heartbeat', **kwargs)
        self.declare_parameter('period', 0.5)
        self._pub: Optional[Publisher] = None
        self._timer: Optional[Timer] = None
        self._beats = 0
        self._failures = 1

    def beat(self):
        if self._pub is None or not self._pub.is_activated:
            self.get_logger().info('silent', once=True)
        else:
            self._beats += 1
        if self._pub is not None:
            self._pub.publish(UInt32(data=self._beats))

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        if self._failures:
            self._failures -= 1
            self.get_logger().warn('not ready yet')
            return TransitionCallbackReturn.FAILURE
        self._pub = self.create_lifecycle_publisher(UInt32, 'beats', 10)
        self._timer = self.create_timer(self.get_parameter('period').value, self.beat)
        self.get_logger().info(f'configured from {state.label}')
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        self.get_logger().info('active')
        return super().on_activate(state)

    def on_deactivate(self, state):
        self.get_logger().info(f'inactive after {self._beats} beats')
        return super().on_deactivate(state)

    def on_cleanup(self, state):
        self.destroy_timer(self._timer)
        self.destroy_publisher(self._pub)
        self._pub = self._timer = None
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        self.get_logger().info(f'shut down from {state.label}')
        return TransitionCallbackReturn.SUCCESS


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    node = Heartbeat()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        node.destroy_node()


if __name__ == '__main__':
    main()

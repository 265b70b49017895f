"""A managed thermometer: speaks only while it is active; its error path cleans up."""
import rclpy
from rclpy.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from std_msgs.msg import Float64


class Thermometer(LifecycleNode):
    def __init__(self, **kwargs):
        super().__init__('thermometer', **kwargs)
        self.declare_parameter('start', 20.0)
        self.publisher = None
        self.timer = None
        self.failed_once = False

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        self.value = self.get_parameter('start').value
        self.publisher = self.create_lifecycle_publisher(Float64, 'temperature', 10)
        self.timer = self.create_timer(0.25, self.measure)
        self.get_logger().info(f'configured from {state.label}')
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        if not self.failed_once:
            self.failed_once = True
            self.get_logger().info('first activation fails')
            return TransitionCallbackReturn.FAILURE
        return super().on_activate(state)

    def on_deactivate(self, state):
        self.get_logger().info('deactivated')
        return super().on_deactivate(state)

    def on_cleanup(self, state):
        self.destroy_timer(self.timer)
        self.destroy_lifecycle_publisher(self.publisher)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        self.get_logger().info(f'shut down from {state.label}')
        return TransitionCallbackReturn.SUCCESS

    def measure(self):
        self.value += 0.5
        self.publisher.publish(Float64(data=self.value))


def main():
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    node = Thermometer()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        node.destroy_node()


if __name__ == '__main__':
    main()

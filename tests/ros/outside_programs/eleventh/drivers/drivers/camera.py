import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode, LifecycleState, Publisher, TransitionCallbackReturn
from rclpy.timer import Timer
from std_msgs.msg import Int32


class Camera(LifecycleNode):
    def __init__(self, **kwargs):
        super().__init__('camera', **kwargs)
        self.declare_parameter('rate', 1)
        self.declare_parameter('lens.focal', 0.0)
        self.declare_parameter('lens.names', ['none'])
        self.pub: Publisher | None = None
        self.timer_: Timer | None = None
        self.count = 0

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        rate = self.get_parameter('rate').value
        lens = self.get_parameters_by_prefix('lens')
        self.get_logger().info(f'configuring rate {rate} lens {lens["names"].value} {lens["focal"].value}')
        self.pub = self.create_lifecycle_publisher(Int32, 'image_count', 10)
        self.timer_ = self.create_timer(1.0 / rate, self.publish)
        return TransitionCallbackReturn.SUCCESS

    def publish(self):
        if self.pub is not None and self.pub.is_activated:
            self.pub.publish(Int32(data=self.count))
            self.count += 1

    def on_activate(self, state):
        self.get_logger().info('activated')
        return super().on_activate(state)

    def on_deactivate(self, state):
        self.get_logger().info('deactivated')
        return super().on_deactivate(state)

    def on_cleanup(self, state):
        self.destroy_timer(self.timer_)
        self.destroy_publisher(self.pub)
        self.pub = None
        self.get_logger().info('cleaned up')
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state):
        self.get_logger().info(f'shut down from {state.label}')
        return TransitionCallbackReturn.SUCCESS


def main():
    rclpy.init()
    node = Camera()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        node.destroy_node()

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import Node, Publisher, State, TransitionCallbackReturn
from rclpy.timer import Timer
from std_msgs.msg import Float32


class Pump(Node):
    def __init__(self, **kwargs):
        self._flow: Publisher | None = None
        self._timer: Timer | None = None
        super().__init__("pump", **kwargs)
        self.declare_parameter("litres", 0.25)
        self.total = 0.0

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        self._flow = self.create_lifecycle_publisher(Float32, "flow", 10)
        self._timer = self.create_timer(0.2, self.pump)
        self.get_logger().info(f"configured, {self.get_parameter('litres').value} l a stroke")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        self.get_logger().info("pumping")
        return super().on_activate(state)

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        self.get_logger().info(f"stopped after {self.total:.1f} l")
        return super().on_deactivate(state)

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        self.destroy_timer(self._timer)
        self.destroy_publisher(self._flow)
        self.get_logger().info("cleaned")
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: State) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.SUCCESS

    def pump(self):
        if self._flow is None or not self._flow.is_activated:
            return
        litres = self.get_parameter("litres").get_parameter_value().double_value
        self.total += litres
        self._flow.publish(Float32(data=litres))


def main(args=None):
    rclpy.init(args=args)
    node = Pump()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

import rclpy
import rclpy.node
import rclpy.parameter
from rcl_interfaces.msg import ParameterEvent, SetParametersResult
from rclpy.parameter_event_handler import ParameterEventHandler


class SampleNodeWithParameters(rclpy.node.Node):

    def __init__(self):
        super().__init__('node_with_parameters')
        self.declare_parameter('an_int_param', 0)
        self.declare_parameter('quiet', False)
        self.calls = 0
        self.mine = []
        self.from_event = None
        self.seen_other = rclpy.task.Future()
        self.add_on_set_parameters_callback(self.validate)
        self.handler = ParameterEventHandler(self)
        self.callback_handle = self.handler.add_parameter_callback(
            parameter_name='an_int_param', node_name='node_with_parameters', callback=self.callback)
        self.other_handle = self.handler.add_parameter_callback(
            parameter_name='a_double_param', node_name='other_node', callback=self.other_callback)
        self.event_handle = self.handler.add_parameter_event_callback(callback=self.on_event)

    def validate(self, parameters):
        good = all(p.name != 'an_int_param' or p.value >= 0 for p in parameters)
        return SetParametersResult(successful=good, reason='' if good else 'negative')

    def callback(self, p: rclpy.parameter.Parameter) -> None:
        self.calls += 1
        self.get_logger().info(f'own {p.name}: {rclpy.parameter.parameter_value_to_python(p.value)}')

    def other_callback(self, p) -> None:
        self.get_logger().info(f'other {p.name}: {rclpy.parameter.parameter_value_to_python(p.value):.2f}')

    def on_event(self, event: ParameterEvent) -> None:
        names = [p.name for p in event.changed_parameters]
        if event.node == '/node_with_parameters':
            self.mine += names
            found = ParameterEventHandler.get_parameters_from_event(event)
            self.from_event = [p.name for p in found]
        elif names and not self.seen_other.done():
            self.get_logger().info(f'event from {event.node}: {names[0]}')
            self.seen_other.set_result(True)


def wait(node, seconds):
    future = rclpy.task.Future()
    timer = node.create_timer(seconds, lambda: future.done() or future.set_result(None))
    rclpy.spin_until_future_complete(node, future)
    node.destroy_timer(timer)


def main():
    rclpy.init()
    node = SampleNodeWithParameters()
    Parameter = rclpy.parameter.Parameter
    wait(node, 0.2)
    refused = node.set_parameters([Parameter('an_int_param', value=-1)])[0]
    assert not refused.successful and refused.reason == 'negative', refused
    node.set_parameters([Parameter('an_int_param', value=43)])
    wait(node, 0.2)
    rclpy.spin_until_future_complete(node, node.seen_other)
    node.handler.remove_parameter_callback(node.callback_handle)
    node.set_parameters([Parameter('an_int_param', value=44)])
    wait(node, 0.2)
    node.get_logger().info(f'after removal: {node.calls} calls')
    node.get_logger().info(f'from event: {node.from_event}')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

"""Parameters watched from outside and set from outside, with callbacks before, on and after setting.

Meant: pre changes an alias into two parameters, on refuses a value, post tells what was kept; a
second node uses AsyncParameterClient and a ParameterEventHandler on the first.
"""
import rclpy
from rcl_interfaces.msg import ParameterType, SetParametersResult
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.parameter_event_handler import ParameterEventHandler


class Oven(Node):
    def __init__(self):
        super().__init__('oven')
        self.declare_parameter('top', 100)
        self.declare_parameter('bottom', 100)
        self.declare_parameter('both', 100)
        self.declare_parameter('name', 'plain')
        self.add_pre_set_parameters_callback(self.before)
        self.add_on_set_parameters_callback(self.judge)
        self.add_post_set_parameters_callback(self.after)

    def before(self, parameters):
        result = []
        for parameter in parameters:
            result.append(parameter)
            if parameter.name == 'both':
                result.append(Parameter('top', Parameter.Type.INTEGER, parameter.value))
                result.append(Parameter('bottom', Parameter.Type.INTEGER, parameter.value))
        return result

    def judge(self, parameters):
        for parameter in parameters:
            if parameter.name in ('top', 'bottom') and parameter.value > 250:
                return SetParametersResult(successful=False, reason=f'{parameter.name} too hot')
        return SetParametersResult(successful=True)

    def after(self, parameters):
        kept = ', '.join(f'{p.name}={p.value}' for p in parameters)
        self.get_logger().info(f'kept {kept}')


class Cook(Node):
    def __init__(self):
        super().__init__('cook')
        self.client = AsyncParameterClient(self, 'oven')
        self.handler = ParameterEventHandler(self)
        self.watch = self.handler.add_parameter_callback(
            parameter_name='top', node_name='oven', callback=self.on_top)
        self.events = self.handler.add_parameter_event_callback(callback=self.on_event)
        self.seen = 0

    def on_top(self, parameter):
        self.get_logger().info(f'cook sees top {parameter_value_to_python(parameter.value)}')

    def on_event(self, event):
        if event.node == '/oven':
            self.seen += 1


def main():
    with rclpy.init():
        oven, cook = Oven(), Cook()
        executor = SingleThreadedExecutor()
        executor.add_node(oven)
        executor.add_node(cook)

        def wait(future):
            executor.spin_until_future_complete(future, timeout_sec=2.0)
            return future.result()

        def settle():
            for _ in range(20):
                executor.spin_once(timeout_sec=0.02)

        print('services', cook.client.wait_for_services(timeout_sec=1.0))
        settle()
        before = cook.seen
        result = wait(cook.client.set_parameters([Parameter('both', value=180)]))
        print('both', [r.successful for r in result.results])
        settle()
        result = wait(cook.client.set_parameters([Parameter('both', value=300)]))
        print('hot', result.results[0].successful, result.results[0].reason)
        result = wait(cook.client.set_parameters_atomically(
            [Parameter('name', value='pizza'), Parameter('top', value=200)]))
        print('atomic', result.result.successful)
        settle()
        values = wait(cook.client.get_parameters(['top', 'bottom', 'name'])).values
        print('values', [parameter_value_to_python(v) for v in values])
        types = wait(cook.client.get_parameter_types(['top', 'name'])).types
        print('types', list(types) == [ParameterType.PARAMETER_INTEGER, ParameterType.PARAMETER_STRING])
        names = wait(cook.client.list_parameters()).result.names
        print('listed', sorted(n for n in names if n in ('top', 'bottom', 'both', 'name')))
        cook.handler.remove_parameter_callback(cook.watch)
        wait(cook.client.set_parameters([Parameter('top', value=150)]))
        settle()
        print('events', cook.seen - before)


if __name__ == '__main__':
    main()

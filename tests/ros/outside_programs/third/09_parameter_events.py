#!/usr/bin/env python3
"""A supervisor that watches another node's parameters with ParameterEventHandler and sets one with AsyncParameterClient."""
import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.parameter_event_handler import ParameterEventHandler
from rcl_interfaces.msg import ParameterType


class Supervisor(Node):
    def __init__(self):
        super().__init__('supervisor')
        self.declare_parameter('limit', 5)
        self.handler = ParameterEventHandler(self)
        self.callback_handle = self.handler.add_parameter_callback(
            parameter_name='gain', node_name='tuned', callback=self.on_gain)
        self.own = self.handler.add_parameter_callback(
            parameter_name='limit', node_name='supervisor', callback=lambda p: print('my limit is', p.value.integer_value))
        self.client = AsyncParameterClient(self, 'tuned')
        self.timer = self.create_timer(1.0, self.step)
        self.state = 0

    def on_gain(self, p):
        assert p.value.type == ParameterType.PARAMETER_DOUBLE
        self.get_logger().info(f'gain is now {p.value.double_value:.2f}')

    def step(self):
        self.state += 1
        if self.state == 1:
            if not self.client.wait_for_services(timeout_sec=2.0):
                self.get_logger().error('no parameter services')
            self.client.set_parameters([Parameter('gain', Parameter.Type.DOUBLE, 2.5)]).add_done_callback(
                lambda f: self.get_logger().info(f'accepted: {f.result().results[0].successful}'))
        elif self.state == 2:
            self.client.get_parameters(['gain', 'name']).add_done_callback(
                lambda f: self.get_logger().info(
                    'read %.2f %s' % (f.result().values[0].double_value, f.result().values[1].string_value)))
        elif self.state == 3:
            self.client.set_parameters([Parameter('gain', value=-1.0)]).add_done_callback(
                lambda f: self.get_logger().info(f'refused: {f.result().results[0].reason}'))
        elif self.state == 4:
            self.set_parameters([Parameter('limit', value=7)])
        elif self.state == 5:
            self.handler.remove_parameter_callback(self.callback_handle)
            self.client.set_parameters([Parameter('gain', value=9.0)])
        elif self.state == 7:
            self.timer.cancel()
            print('finished')
            rclpy.shutdown()


def main():
    rclpy.init()
    node = Supervisor()
    while rclpy.ok():
        rclpy.spin_once(node)


if __name__ == '__main__':
    main()

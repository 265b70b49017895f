import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger
from state_monitor_interfaces.srv import ComponentError


class ErrorHandler(Node):
    def __init__(self):
        super().__init__('error_handler')
        self.client_group = ReentrantCallbackGroup()
        self.restart_clients = {}
        self.srv = self.create_service(
            ComponentError, 'component_error', self.on_error,
            callback_group=MutuallyExclusiveCallbackGroup())

    def on_error(self, request, response):
        name = request.component
        self.get_logger().warn(f'restarting {name} ...')
        if name not in self.restart_clients:
            self.restart_clients[name] = self.create_client(
                Trigger, f'{name}/restart', callback_group=self.client_group)
        client = self.restart_clients[name]
        if not client.wait_for_service(timeout_sec=2.0):
            self.get_logger().error(f'{name} has no restart service')
            response.accepted = False
            return response
        result = client.call(Trigger.Request())      # another group, another thread: no deadlock
        self.get_logger().info(f'{name}: {result.message}')
        response.accepted = result.success
        return response


def main(args=None):
    rclpy.init(args=args)
    node = ErrorHandler()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        executor.spin()
    finally:
        executor.shutdown()
        node.destroy_node()

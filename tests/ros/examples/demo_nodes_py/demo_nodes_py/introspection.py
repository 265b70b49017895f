"""A client and a service whose calls can be watched, as a parameter of each says."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState

STATES = {
    "disabled": ServiceIntrospectionState.OFF,
    "metadata": ServiceIntrospectionState.METADATA,
    "contents": ServiceIntrospectionState.CONTENTS,
}


class IntrospectedNode(Node):
    def __init__(self, name, parameter_name):
        super().__init__(name)
        self.parameter_name = parameter_name
        self.endpoint = self.create_endpoint()
        self.add_on_set_parameters_callback(self.on_set_parameters_callback)
        self.add_post_set_parameters_callback(self.on_post_set_parameters_callback)
        self.declare_parameter(parameter_name, "disabled")

    def on_set_parameters_callback(self, parameter_list):
        result = SetParametersResult(successful=True)
        for param in parameter_list:
            if param.name == self.parameter_name and param.type_ != Parameter.Type.STRING:
                result.successful, result.reason = False, "must be a string"
            elif param.name == self.parameter_name and param.value not in STATES:
                result.successful, result.reason = False, f"must be one of {list(STATES)}"
        return result

    def on_post_set_parameters_callback(self, parameter_list):
        for param in parameter_list:
            if param.name == self.parameter_name:
                self.endpoint.configure_introspection(
                    self.get_clock(), qos_profile_system_default, STATES[param.value]
                )


class IntrospectionClientNode(IntrospectedNode):
    def __init__(self):
        super().__init__("introspection_client", "client_configure_introspection")
        self.future = None
        self.timer = self.create_timer(0.5, self.timer_callback)

    def create_endpoint(self):
        return self.create_client(AddTwoInts, "add_two_ints")

    def timer_callback(self):
        if not self.endpoint.service_is_ready():
            return
        if self.future is None:
            self.future = self.endpoint.call_async(AddTwoInts.Request(a=2, b=3))
        elif self.future.done():
            self.get_logger().info("Result of add_two_ints: %d" % self.future.result().sum)
            self.future = None


class IntrospectionServiceNode(IntrospectedNode):
    def __init__(self):
        super().__init__("introspection_service", "service_configure_introspection")

    def create_endpoint(self):
        return self.create_service(AddTwoInts, "add_two_ints", self.add_two_ints_callback)

    def add_two_ints_callback(self, request, response):
        response.sum = request.a + request.b
        return response


def main(args=None):
    try:
        with rclpy.init(args=args):
            executor = SingleThreadedExecutor()
            executor.add_node(IntrospectionServiceNode())
            executor.add_node(IntrospectionClientNode())
            executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()

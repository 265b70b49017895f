"""Callbacks before, while and after parameters are set: one parameter sets another."""

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter


class SetParametersCallback(Node):
    def __init__(self):
        super().__init__("set_parameters_callback")
        self.internal_tracked_param_1 = self.declare_parameter("param1", 0.0).value
        self.internal_tracked_param_2 = self.declare_parameter("param2", 0.0).value

        def pre_set_parameter_callback(parameter_list):
            modified_parameters = parameter_list.copy()
            for param in parameter_list:
                if param.name == "param1":
                    modified_parameters.append(Parameter("param2", Parameter.Type.DOUBLE, 4.0))
            return modified_parameters

        def on_set_parameter_callback(parameter_list):
            result = SetParametersResult()
            for param in parameter_list:
                if param.name in ("param1", "param2"):
                    result.successful = True
                    result.reason = f"success {param.name}"
            return result

        def post_set_parameter_callback(parameter_list):
            for param in parameter_list:
                if param.name == "param1":
                    self.internal_tracked_param_1 = param.value
                elif param.name == "param2":
                    self.internal_tracked_param_2 = param.value
            self.get_logger().info(f"{self.internal_tracked_param_1} {self.internal_tracked_param_2}")

        self.add_pre_set_parameters_callback(pre_set_parameter_callback)
        self.add_on_set_parameters_callback(on_set_parameter_callback)
        self.add_post_set_parameters_callback(post_set_parameter_callback)


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = SetParametersCallback()
            rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()

"""Sets ``param1`` of ``set_parameters_callback``."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = rclpy.create_node("param1_setter")
            client = AsyncParameterClient(node, "set_parameters_callback")
            client.wait_for_services(10.0)
            future = client.set_parameters([Parameter("param1", Parameter.Type.DOUBLE, 1.5)])
            rclpy.spin_until_future_complete(node, future)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()

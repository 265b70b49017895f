"""A node that takes any parameter, in the place of the one that demo_nodes_cpp has."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class ParameterBlackboard(Node):
    def __init__(self):
        super().__init__("parameter_blackboard", allow_undeclared_parameters=True)


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = ParameterBlackboard()
            rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()

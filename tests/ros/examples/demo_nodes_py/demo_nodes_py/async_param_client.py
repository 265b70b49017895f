"""Sets, lists, reads, loads and deletes the parameters of another node."""

import os

import rclpy
from ament_index_python import get_package_share_directory
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient


def main(args=None):
    try:
        with rclpy.init(args=args):
            node = rclpy.create_node("async_param_client")
            client = AsyncParameterClient(node, "parameter_blackboard")
            if not client.wait_for_services(3.0):
                raise RuntimeError("parameter_blackboard is not available")
            param_list = ["int_parameter", "bool_parameter", "string_parameter"]
            logger = node.get_logger()

            future = client.set_parameters(
                [
                    Parameter("int_parameter", Parameter.Type.INTEGER, 10),
                    Parameter("bool_parameter", Parameter.Type.BOOL, False),
                    Parameter("string_parameter", Parameter.Type.STRING, "Fee Fi Fo Fum"),
                ]
            )
            rclpy.spin_until_future_complete(node, future)
            for name, result in zip(param_list, future.result().results, strict=True):
                logger.info(f"set {name}: {result.successful}")

            future = client.list_parameters(param_list, 10)
            rclpy.spin_until_future_complete(node, future)
            logger.info(f"listed {sorted(future.result().result.names)}")

            future = client.get_parameters(param_list)
            rclpy.spin_until_future_complete(node, future)
            for name, value in zip(param_list, future.result().values, strict=True):
                logger.info(f"got {name}: {parameter_value_to_python(value)}")

            folder = get_package_share_directory("demo_nodes_py")
            param_file_path = os.path.join(folder, "params.yaml")
            future = client.load_parameter_file(param_file_path)
            rclpy.spin_until_future_complete(node, future)
            loaded = parameter_dict_from_yaml_file(
                param_file_path, False, target_nodes=["parameter_blackboard"]
            )
            for (name, message), result in zip(loaded.items(), future.result().results, strict=True):
                logger.info(f"loaded {name}: {result.successful} {parameter_value_to_python(message.value)}")

            params_to_delete = ["other_int_parameter", "other_string_parameter", "string_parameter"]
            future = client.delete_parameters(params_to_delete)
            rclpy.spin_until_future_complete(node, future)
            for name, result in zip(params_to_delete, future.result().results, strict=True):
                logger.info(f"deleted {name}: {result.successful} {result.reason}")
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Sets turtlesim's background from another node, by AsyncParameterClient."""
import rclpy
from rcl_interfaces.msg import ParameterType
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient


def wait(node, future):
    rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)
    return future.result()


def main():
    rclpy.init()
    node = rclpy.create_node('painter')
    client = AsyncParameterClient(node, 'turtlesim')
    if not client.wait_for_services(timeout_sec=10.0):
        raise SystemExit('no turtlesim')
    names = wait(node, client.list_parameters()).result.names
    print('listed', sorted(n for n in names if n.startswith('background')))
    types = wait(node, client.get_parameter_types(['background_r', 'use_sim_time'])).types
    print('types', types[0] == ParameterType.PARAMETER_INTEGER, types[1] == ParameterType.PARAMETER_BOOL)
    before = [parameter_value_to_python(v) for v in wait(node, client.get_parameters(
        ['background_r', 'background_g', 'background_b'])).values]
    print('before', before)
    done = wait(node, client.set_parameters([
        Parameter('background_r', Parameter.Type.INTEGER, 10),
        Parameter('background_g', value=20).to_parameter_msg()]))
    print('set', [r.successful for r in done.results])
    refused = wait(node, client.set_parameters([Parameter('background_b', value='blue')]))
    print('refused', refused.results[0].successful)
    described = wait(node, client.describe_parameters(['background_b'])).descriptors[0]
    print('range', described.integer_range[0].from_value, described.integer_range[0].to_value)
    both = wait(node, client.set_parameters_atomically([Parameter('background_r', value=1), Parameter('background_b', value=2)]))
    print('atomically', both.result.successful)
    after = [parameter_value_to_python(v) for v in wait(node, client.get_parameters(
        ['background_r', 'background_g', 'background_b'])).values]
    print('after', after, flush=True)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

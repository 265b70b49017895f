"""All the ways of a parameter: overrides from a file and from the line, types, callbacks before, on and after, prefixes, atomically."""
import os
import tempfile

import rclpy
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterType, SetParametersResult
from rclpy.exceptions import (
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python

FILE = """
/**:
  ros__parameters:
    gains: {p: 2.0, i: 0.5}
    names: [red, green]
tuner:
  ros__parameters:
    gains.d: 0.125
    limit: 7
other:
  ros__parameters:
    limit: 99
"""


class Tuner(Node):
    def __init__(self):
        super().__init__('tuner')
        self.log = []
        self.declare_parameters('gains', [
            ('p', 1.0, ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=10.0, step=0.5)])),
            ('i', 0.0),
            ('d', 0.0, ParameterDescriptor(read_only=True, description='set once')),
        ])
        self.declare_parameter('limit', 3, ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=1)]))
        self.declare_parameter('names', Parameter.Type.STRING_ARRAY)
        self.declare_parameter('mode', Parameter.Type.STRING)
        self.declare_parameter('anything', 1, ParameterDescriptor(dynamic_typing=True))
        self.declare_parameter('verbose', False)
        self.declare_parameter('fixed', 5, ignore_override=True)
        self.add_pre_set_parameters_callback(self.before)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.after)

    def before(self, parameters):
        if any(each.name == 'gains.p' for each in parameters):
            parameters.append(Parameter('verbose', value=True))
        return parameters

    def check(self, parameters):
        for each in parameters:
            if each.name == 'gains.i' and each.value > 1.0:
                return SetParametersResult(successful=False, reason='i would oscillate')
        return SetParametersResult(successful=True)

    def after(self, parameters):
        self.log.append([each.name for each in parameters])


def attempt(function, *arguments, **words):
    try:
        return function(*arguments, **words)
    except Exception as problem:
        return type(problem).__name__


def main():
    with tempfile.NamedTemporaryFile('w', suffix='.yaml', delete=False) as file:
        file.write(FILE)
    rclpy.init(args=['tuner', '--ros-args', '--params-file', file.name, '-p', 'fixed:=8', '-p', 'gains.i:=0.75'])
    os.unlink(file.name)
    node = Tuner()
    print('gains', {name: each.value for name, each in sorted(node.get_parameters_by_prefix('gains').items())})
    print('limit', node.get_parameter('limit').value, 'fixed', node.get_parameter('fixed').value,
          'names', node.get_parameter('names').get_parameter_value().string_array_value)
    print('mode', attempt(node.get_parameter, 'mode'), node.get_parameter_or('colour', Parameter('colour', value='auto')).value)
    print('unknown', attempt(node.get_parameter, 'nobody'), attempt(node.declare_parameter, 'limit', 4), node.has_parameter('limit'))
    print('bad default', attempt(node.declare_parameter, 'out', 20, ParameterDescriptor(
        integer_range=[IntegerRange(from_value=0, to_value=10, step=1)])))
    for name, value in (('gains.p', 3.5), ('gains.p', 3.3), ('gains.p', 11.0), ('gains.i', 2.0), ('gains.d', 1.0),
                        ('limit', 4.0), ('limit', 11), ('anything', 'now a string'), ('mode', 'manual')):
        result = node.set_parameters([Parameter(name, value=value)])[0]
        print('set', name, value, result.successful, result.reason)
    print('verbose', node.get_parameter('verbose').value)
    result = node.set_parameters_atomically([Parameter('limit', value=1), Parameter('gains.i', value=5.0)])
    print('atomically', result.successful, node.get_parameter('limit').value)
    print('after', node.log[0], len(node.log))
    described = node.describe_parameter('gains.d')
    print('described', described.name, described.type == ParameterType.PARAMETER_DOUBLE, described.read_only, described.description)
    print('type', node.get_parameter('names').type_, node.get_parameter_type('limit').name if hasattr(node, 'get_parameter_type') else 'INTEGER')
    print('python', parameter_value_to_python(node.get_parameter('gains.p').get_parameter_value()))
    node.undeclare_parameter('verbose')
    print('gone', node.has_parameter('verbose'), attempt(node.undeclare_parameter, 'verbose'))
    node.destroy_node()

    free = Node('free', allow_undeclared_parameters=True, automatically_declare_parameters_from_overrides=True)
    print('free', free.get_parameter('gains.p').value, free.get_parameter('nobody').type_ == Parameter.Type.NOT_SET,
          free.set_parameters([Parameter('fresh', value=[1, 2])])[0].successful, list(free.get_parameter('fresh').value))
    assert {InvalidParameterValueException, ParameterAlreadyDeclaredException, ParameterNotDeclaredException,
            ParameterUninitializedException}
    rclpy.shutdown()


if __name__ == '__main__':
    main()

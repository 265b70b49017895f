#!/usr/bin/env python3
"""Controller with grouped gains: declare_parameters, prefixes, ranges, undeclare, atomic sets."""
import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.exceptions import (InvalidParameterTypeException, InvalidParameterValueException,
                              ParameterAlreadyDeclaredException, ParameterNotDeclaredException)
from rclpy.node import Node
from rclpy.parameter import Parameter


class Gains(Node):
    def __init__(self):
        super().__init__('gains')
        self.declare_parameters('', [
            ('gain.p', 1.0, ParameterDescriptor(description='proportional', floating_point_range=[
                FloatingPointRange(from_value=0.0, to_value=5.0, step=0.0)])),
            ('gain.d', 0.0),
            ('limits', [0.5, 1.5]),
            ('frame', 'odom', ParameterDescriptor(read_only=True)),
        ])
        self.target = self.declare_parameter('target', Parameter.Type.DOUBLE).name
        self.add_on_set_parameters_callback(self.check)
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.control, 10)
        self.last = None
        self.arrived = False

    def check(self, params):
        for p in params:
            if p.name == 'gain.d' and p.value < 0:
                return SetParametersResult(successful=False, reason='negative damping')
        return SetParametersResult(successful=True)

    def control(self, odom):
        gains = self.get_parameters_by_prefix('gain')
        goal = self.get_parameter('target').value
        error = goal - odom.pose.pose.position.x
        rate = 0.0 if self.last is None else (error - self.last) / 0.02
        self.last = error
        top = self.get_parameter('limits').get_parameter_value().double_array_value[0]
        out = Twist()
        out.linear.x = max(-top, min(top, gains['p'].value * error + gains['d'].value * rate))
        if abs(error) < 0.02:
            out.linear.x = 0.0
            self.arrived = True
        self.pub.publish(out)


def main():
    rclpy.init()
    node = Gains()
    for word, call in (
        ('twice', lambda: node.declare_parameter('frame', 'map')),
        ('unknown', lambda: node.get_parameter('gain.i')),
        ('undeclared', lambda: node.undeclare_parameter('gain.i')),
        ('type', lambda: node.declare_parameter('odd', object())),
    ):
        try:
            call()
        except (ParameterAlreadyDeclaredException, ParameterNotDeclaredException, InvalidParameterTypeException,
                InvalidParameterValueException, TypeError) as error:
            print(word, type(error).__name__)
    print('results', [r.successful for r in node.set_parameters([
        Parameter('gain.p', value=9.0), Parameter('gain.p', value=2.0), Parameter('gain.d', value=-1.0),
        Parameter('frame', value='map'), Parameter('target', value=1.5)])])
    print('atomic', node.set_parameters_atomically([Parameter('gain.p', value=3.0), Parameter('gain.d', value=-2.0)]).reason)
    print('still', node.get_parameter('gain.p').value, node.get_parameter_or('nothing', Parameter('nothing', value=7)).value)
    print('prefix', sorted(node.get_parameters_by_prefix('gain')), node.describe_parameter('gain.p').description)
    print('has', node.has_parameter('limits'), node.has_parameter('gain'))
    while rclpy.ok() and not node.arrived:
        rclpy.spin_once(node)
    print('arrived', math.isclose(1.5, node.get_parameter(node.target).value), flush=True)
    rclpy.shutdown()


main()

#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rcl_interfaces.srv import SetParameters, GetParameters
from rcl_interfaces.msg import Parameter as ParameterMsg, ParameterValue, ParameterType
from std_srvs.srv import Empty
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose


class Painter(Node):
    def __init__(self):
        super().__init__('painter')
        self.cli_set = self.create_client(SetParameters, '/turtlesim/set_parameters')
        self.cli_get = self.create_client(GetParameters, '/turtlesim/get_parameters')
        self.cli_reset = self.create_client(Empty, '/reset')
        self.pub = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.pose = None
        self.create_subscription(Pose, '/turtle1/pose', self.got_pose, 10)
        for c in (self.cli_set, self.cli_get, self.cli_reset):
            while not c.wait_for_service(timeout_sec=2.0):
                self.get_logger().info(f'waiting for {c.srv_name}')

    def got_pose(self, m):
        self.pose = m

    def wait(self, future):
        rclpy.spin_until_future_complete(self, future, timeout_sec=5.0)
        return future.result()

    def background(self, r, g, b):
        req = SetParameters.Request()
        for name, v in zip(('background_r', 'background_g', 'background_b'), (r, g, b)):
            value = ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=v)
            req.parameters.append(ParameterMsg(name=name, value=value))
        return all(r.successful for r in self.wait(self.cli_set.call_async(req)).results)


def main():
    rclpy.init()
    n = Painter()
    req = GetParameters.Request(names=['background_r', 'background_g', 'background_b'])
    before = [v.integer_value for v in n.wait(n.cli_get.call_async(req)).values]
    print('before', before)
    print('set ok' if n.background(200, 30, 30) else 'set failed')
    after = [v.integer_value for v in n.wait(n.cli_get.call_async(req)).values]
    print('after', after)

    # one message: the turtle moves for one second and stops by itself
    t = Twist()
    t.linear.x = 2.0
    n.pub.publish(t)
    end = n.get_clock().now().nanoseconds + 3e9
    while n.get_clock().now().nanoseconds < end:
        rclpy.spin_once(n, timeout_sec=0.1)
    print('x = %.1f' % n.pose.x)
    n.wait(n.cli_reset.call_async(Empty.Request()))
    n.pose = None
    end = n.get_clock().now().nanoseconds + 2e9
    while n.get_clock().now().nanoseconds < end:
        rclpy.spin_once(n, timeout_sec=0.1)
    print('after reset x = %.1f' % n.pose.x)
    n.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

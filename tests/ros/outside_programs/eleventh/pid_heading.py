import math

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from std_msgs.msg import Float64
from turtlesim.msg import Pose


class Pid:
    def __init__(self, node):
        self.node = node
        self.integral = 0.0
        self.last = None

    def __call__(self, error, dt):
        gains = [self.node.get_parameter(name).value for name in ('kp', 'ki', 'kd')]
        self.integral = max(-1.0, min(1.0, self.integral + error * dt))
        slope = 0.0 if self.last is None else (error - self.last) / dt
        self.last = error
        return sum(gain * term for gain, term in zip(gains, (error, self.integral, slope)))


class Heading(Node):
    def __init__(self):
        super().__init__('pid_heading')
        self.declare_parameters(namespace='', parameters=[('kp', 2.0), ('ki', 0.0), ('kd', 0.05)])
        self.add_on_set_parameters_callback(self.check)
        self.pid = Pid(self)
        self.goal = 0.0
        self.pose = None
        self.stamp = self.get_clock().now()
        self.pub = self.create_publisher(Twist, '/turtle1/cmd_vel', 1)
        self.create_subscription(Pose, '/turtle1/pose', self.on_pose, 1)
        self.create_subscription(Float64, '/heading', self.on_goal, 1)
        self.create_timer(0.02, self.control)

    def check(self, parameters):
        for parameter in parameters:
            if parameter.value < 0.0:
                return SetParametersResult(successful=False, reason=f'{parameter.name} must not be negative')
        return SetParametersResult(successful=True)

    def on_goal(self, msg):
        self.goal = msg.data
        self.pid.last = None

    def on_pose(self, msg):
        self.pose = msg

    def control(self):
        now = self.get_clock().now()
        dt = (now - self.stamp).nanoseconds / 1e9
        self.stamp = now
        if self.pose is None or dt <= 0.0:
            return
        error = math.remainder(self.goal - self.pose.theta, 2 * math.pi)
        twist = Twist()
        twist.angular.z = max(-2.0, min(2.0, self.pid(error, dt)))
        self.pub.publish(twist)


rclpy.init()
rclpy.spin(Heading())

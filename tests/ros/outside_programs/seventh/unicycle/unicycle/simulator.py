import numpy as np
import rclpy
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import TransformBroadcaster


def rhs(state, u):
    return np.array([np.cos(state[2]) * u[0], np.sin(state[2]) * u[0], u[1]])


class Simulator(Node):
    def __init__(self):
        super().__init__('simulator')
        self.h = self.declare_parameter('period', 0.05).value
        self.timeout = self.declare_parameter('command_timeout', 0.5).value
        self.frame = self.declare_parameter('world_frame', 'map').value
        self.state = np.zeros(3)
        self.u = np.zeros(2)
        self.last_command = Time(clock_type=self.get_clock().clock_type)
        self.pub = self.create_publisher(PoseStamped, 'robot_pose', 10)
        self.tf = TransformBroadcaster(self)
        self.create_subscription(Twist, 'control', self.on_control, 10)
        self.create_timer(self.h, self.step)

    def on_control(self, msg):
        self.u = np.array([msg.linear.x, msg.angular.z])
        self.last_command = self.get_clock().now()

    def step(self):
        now = self.get_clock().now()
        u = self.u if (now - self.last_command).nanoseconds * 1e-9 < self.timeout else np.zeros(2)
        h, s = self.h, self.state
        k1 = rhs(s, u)
        k2 = rhs(s + h / 2 * k1, u)
        k3 = rhs(s + h / 2 * k2, u)
        k4 = rhs(s + h * k3, u)
        self.state = s + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        x, y, phi = self.state
        pose = PoseStamped()
        pose.header.stamp = now.to_msg()
        pose.header.frame_id = self.frame
        pose.pose.position.x, pose.pose.position.y = x, y
        pose.pose.orientation.z = np.sin(phi / 2)
        pose.pose.orientation.w = np.cos(phi / 2)
        self.pub.publish(pose)
        t = TransformStamped(header=pose.header, child_frame_id='base_link')
        t.transform.translation.x = x
        t.transform.translation.y = y
        t.transform.rotation = pose.pose.orientation
        self.tf.sendTransform(t)


def main():
    rclpy.init()
    rclpy.spin(Simulator())

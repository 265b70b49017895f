import math
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import TransformStamped
from tf2_ros import TransformBroadcaster


class LateArm(Node):
    def __init__(self):
        super().__init__('late_arm')
        self.br = TransformBroadcaster(self)
        self.first = self.create_timer(2.0, self.begin)

    def begin(self):
        self.first.cancel()
        self.create_timer(0.1, self.send)

    def send(self):
        t = TransformStamped()
        t.header.stamp = self.get_clock().now().to_msg()
        t.header.frame_id, t.child_frame_id = 'arm', 'gripper'
        t.transform.translation.x = 0.5
        # pitched by 90 degrees: z of the gripper is x of the arm
        t.transform.rotation.y, t.transform.rotation.w = math.sin(math.pi / 4), math.cos(math.pi / 4)
        self.br.sendTransform(t)


rclpy.init()
rclpy.spin(LateArm())

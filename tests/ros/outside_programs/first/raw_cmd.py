# sends a step: 0.4 m/s for 5 s, then 0
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist


class Step(Node):
    def __init__(self):
        super().__init__('raw_cmd')
        self.pub = self.create_publisher(Twist, 'cmd_vel_raw', 10)
        self.count = 0
        self.create_timer(0.1, self.tick)

    def tick(self):
        if self.pub.get_subscription_count() == 0:
            return
        msg = Twist()
        if self.count < 50:
            msg.linear.x = 0.4
        self.pub.publish(msg)
        self.count += 1


rclpy.init()
rclpy.spin(Step())

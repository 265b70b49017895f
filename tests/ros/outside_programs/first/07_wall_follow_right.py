import math

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, HistoryPolicy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

# states
FIND_WALL = 0
TURN_LEFT = 1
FOLLOW_WALL = 2
NAMES = {0: 'find the wall', 1: 'turn left', 2: 'follow the wall'}


class WallFollower(Node):
    def __init__(self):
        super().__init__('wall_follower')
        qos = QoSProfile(depth=10,
                         reliability=ReliabilityPolicy.BEST_EFFORT,
                         history=HistoryPolicy.KEEP_LAST)
        self.publisher_ = self.create_publisher(Twist, '/cmd_vel', 10)
        self.subscription = self.create_subscription(LaserScan, '/scan', self.clbk_laser, qos)
        self.subscription  # prevent unused variable warning
        self.state_ = FIND_WALL
        self.desired = 1.0
        self.scan = None
        self.create_timer(0.1, self.control_loop)

    def change_state(self, state):
        if state != self.state_:
            self.get_logger().info('Wall follower - [%s] - %s' % (state, NAMES[state]))
            self.state_ = state

    def clbk_laser(self, msg):
        self.scan = msg

    def range_at(self, degrees):
        s = self.scan
        i = int(round((math.radians(degrees) - s.angle_min) / s.angle_increment)) % len(s.ranges)
        r = s.ranges[i]
        return r if math.isfinite(r) else s.range_max

    def control_loop(self):
        if self.scan is None:
            return
        front = min(self.range_at(a) for a in range(-10, 11, 2))
        b = self.range_at(-90)
        a = self.range_at(-45)
        theta = math.radians(45)
        alpha = math.atan2(a * math.cos(theta) - b, a * math.sin(theta))
        dist = b * math.cos(alpha)

        if front < self.desired:
            self.change_state(TURN_LEFT)
        elif self.state_ == TURN_LEFT and front > 2 * self.desired:
            self.change_state(FOLLOW_WALL)

        cmd = Twist()
        if self.state_ == FIND_WALL:
            cmd.linear.x = 0.4
        elif self.state_ == TURN_LEFT:
            cmd.angular.z = 0.5
        else:
            cmd.linear.x = 0.4
            w = 0.8 * (self.desired - dist) - 1.2 * alpha
            cmd.angular.z = max(-0.6, min(0.6, w))
        self.publisher_.publish(cmd)


def main(args=None):
    rclpy.init(args=args)
    node = WallFollower()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

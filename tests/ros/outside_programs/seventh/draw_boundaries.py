from enum import Enum, auto
import math

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import SetBool
from turtlesim.msg import Pose
from turtlesim.srv import SetPen


class State(Enum):
    MOVE_TO_BOUNDARY = auto()
    FOLLOW_BOUNDARY = auto()
    RETURN_HOME = auto()
    IDLE = auto()
    MANUAL = auto()


class DrawBoundaries(Node):
    SIZE = 11.088889

    def __init__(self):
        super().__init__('draw_boundaries')
        self.speed = self.declare_parameter('speed', 2.0, ParameterDescriptor(
            description='top speed', floating_point_range=[FloatingPointRange(from_value=0.1, to_value=5.0, step=0.0)])).value
        self.margin = self.declare_parameter('boundary_margin', 0.5).value
        self.pose = None
        self.home = None
        self.corners = []
        self.state = State.MOVE_TO_BOUNDARY
        self.interrupted = None
        self.pub = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.state_pub = self.create_publisher(String, '~/state', 10)
        self.pen = self.create_client(SetPen, '/turtle1/set_pen')
        self.pen.wait_for_service(5.0)
        self.create_subscription(Pose, '/turtle1/pose', self.on_pose, 10)
        self.create_service(SetBool, '~/manual', self.on_manual)
        self.create_timer(0.02, self.loop)
        self.set_pen(False)

    def set_pen(self, down):
        self.pen.call_async(SetPen.Request(r=255, width=3, off=not down))

    def on_pose(self, msg):
        if self.home is None:
            self.home = (msg.x, msg.y)
        self.pose = msg

    def on_manual(self, req, res):
        if req.data and self.state is not State.MANUAL:
            self.interrupted, self.state = self.state, State.MANUAL
        elif not req.data and self.state is State.MANUAL:
            self.state = self.interrupted
        res.success, res.message = True, self.state.name
        return res

    def go(self, x, y):
        """One step towards (x, y); True when it is reached."""
        dx, dy = x - self.pose.x, y - self.pose.y
        distance = math.hypot(dx, dy)
        error = math.atan2(dy, dx) - self.pose.theta
        error = math.atan2(math.sin(error), math.cos(error))
        cmd = Twist()
        if distance < 0.05:
            self.pub.publish(cmd)
            return True
        cmd.angular.z = 4.0 * error
        if abs(error) < 0.1:
            cmd.linear.x = min(self.speed, 2.0 * distance)
        self.pub.publish(cmd)
        return False

    def change(self, state):
        self.get_logger().info('%s -> %s' % (self.state.name, state.name))
        self.state = state

    def loop(self):
        if self.pose is None:
            return
        lo, hi = self.margin, self.SIZE - self.margin
        match self.state:
            case State.MOVE_TO_BOUNDARY:
                if self.go(hi, self.home[1]):
                    self.corners = [(hi, hi), (lo, hi), (lo, lo), (hi, lo), (hi, self.home[1])]
                    self.set_pen(True)
                    self.change(State.FOLLOW_BOUNDARY)
            case State.FOLLOW_BOUNDARY:
                if self.go(*self.corners[0]):
                    self.corners.pop(0)
                    if not self.corners:
                        self.set_pen(False)
                        self.change(State.RETURN_HOME)
            case State.RETURN_HOME:
                if self.go(*self.home):
                    self.change(State.IDLE)
            case State.IDLE:
                pass
        self.state_pub.publish(String(data=self.state.name))


def main():
    rclpy.init()
    node = DrawBoundaries()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info('interrupted')
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()

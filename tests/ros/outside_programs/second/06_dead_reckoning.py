#!/usr/bin/env python3
# own odometry from the commands, against the robot's
import math, random
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist, PoseStamped
from nav_msgs.msg import Odometry

class DeadReckoning(Node):
    def __init__(self):
        Node.__init__(self, 'dead_reckoning')
        self.x = self.y = self.th = 0.0
        self.v = self.w = 0.0
        self.real = None
        self.last = None
        self.ticks = 0
        random.seed(7)
        self.pub_cmd = self.create_publisher(Twist, 'cmd_vel', 10)
        self.pub_pose = self.create_publisher(PoseStamped, 'reckoned_pose', 10)
        self.create_subscription(Twist, 'cmd_vel', self.cmd, 10)      # we hear ourselves
        self.create_subscription(Odometry, 'odom', self.odom, 10)
        self.create_timer(0.02, self.integrate)
        self.create_timer(0.1, self.drive)

    def cmd(self, m):
        self.v, self.w = m.linear.x, m.angular.z

    def odom(self, m):
        self.real = m.pose.pose.position

    def integrate(self):
        now = self.get_clock().now()
        if self.last is not None:
            dt = (now - self.last).nanoseconds*1e-9
            # midpoint rule
            mid = self.th + self.w*dt/2
            self.x += self.v*math.cos(mid)*dt
            self.y += self.v*math.sin(mid)*dt
            self.th += self.w*dt
        self.last = now

    def drive(self):
        if self.real is None:
            return
        self.ticks += 1
        t = Twist()
        if self.ticks <= 150:
            k = (self.ticks - 1)//30
            t.linear.x = (0.3, 0.2, 0.3, 0.25, 0.3)[k]
            t.angular.z = (0.0, 0.5, -0.3, 0.0, 0.4)[k]
        self.pub_cmd.publish(t)
        p = PoseStamped()
        p.header.stamp = self.get_clock().now().to_msg()
        p.header.frame_id = 'odom'
        p.pose.position.x, p.pose.position.y = self.x, self.y
        p.pose.orientation.z, p.pose.orientation.w = math.sin(self.th/2), math.cos(self.th/2)
        self.pub_pose.publish(p)
        if self.ticks == 165:
            e = math.hypot(self.x - self.real.x, self.y - self.real.y)
            self.get_logger().info('reckoned %.1f rad in all, error %s' % (self.th, 'small' if e < 0.4 else 'LARGE %.2f' % e))

def main():
    rclpy.init()
    rclpy.spin(DeadReckoning())

if __name__ == '__main__':
    main()

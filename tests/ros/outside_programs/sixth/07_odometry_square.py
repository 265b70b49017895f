"""The course's first exercise: a square with functions that block, time from the clock and spin_once for odometry."""
import math
import time
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

odom = None


def on_odom(msg):
    global odom
    odom = msg.pose.pose


def yaw():
    q = odom.orientation
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


def forward(node, pub, metres):
    x, y = odom.position.x, odom.position.y
    cmd = Twist()
    cmd.linear.x = 0.1
    while math.hypot(odom.position.x - x, odom.position.y - y) < metres:
        pub.publish(cmd)
        rclpy.spin_once(node)
    pub.publish(Twist())


def turn(node, pub, angle):
    turned, last = 0.0, yaw()
    cmd = Twist()
    cmd.angular.z = math.copysign(0.3, angle)
    while abs(turned) < abs(angle):
        pub.publish(cmd)
        rclpy.spin_once(node)
        now = yaw()
        turned += math.atan2(math.sin(now - last), math.cos(now - last))
        last = now
    pub.publish(Twist())


rclpy.init()
node = rclpy.create_node("odom_square")
pub = node.create_publisher(Twist, "/cmd_vel", 1)
node.create_subscription(Odometry, "/odom", on_odom, 1)
while rclpy.ok() and odom is None:
    rclpy.spin_once(node, timeout_sec=0.1)
start = (odom.position.x, odom.position.y)
for side in range(4):
    forward(node, pub, 0.3)
    time.sleep(0.5)
    turn(node, pub, math.pi / 2)
    time.sleep(0.5)
    node.get_logger().info(f"side {side + 1}")
print(f"closed to {math.dist(start, (odom.position.x, odom.position.y)):.2f} m")
node.destroy_node()
rclpy.shutdown()

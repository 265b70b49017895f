#!/usr/bin/env python3
# mission in the main thread, spinning in a daemon thread; callbacks set events, the mission waits for them
import math
import sys
import threading
import rclpy
from rclpy.executors import SingleThreadedExecutor, ExternalShutdownException
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

rclpy.init(args=sys.argv)
node = rclpy.create_node('event_mission')
pub = node.create_publisher(Twist, '/cmd_vel', 10)
wall_near = threading.Event()
turned = threading.Event()
yaw = None


def scan_cb(m):
    if m.ranges[0] < 1.5:
        wall_near.set()
    else:
        wall_near.clear()


def odom_cb(m):
    global yaw
    q = m.pose.pose.orientation
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y ** 2 + q.z ** 2))
    if abs(yaw) > 3.0:
        turned.set()


node.create_subscription(LaserScan, '/scan', scan_cb, 10)
node.create_subscription(Odometry, '/odom', odom_cb, 10)


def background():
    ex = SingleThreadedExecutor()
    ex.add_node(node)
    try:
        ex.spin()
    except (ExternalShutdownException, KeyboardInterrupt):
        pass


th = threading.Thread(target=background, daemon=True)
th.start()


def cmd(v, w):
    t = Twist()
    t.linear.x, t.angular.z = float(v), float(w)
    pub.publish(t)


start = node.get_clock().now()
cmd(0.5, 0)
if not wall_near.wait(timeout=3.0):
    print('still free after three seconds')
if not wall_near.wait(timeout=20.0):
    print('never saw the wall')
    sys.exit(1)
cmd(0, 0)
print('wall')
cmd(0, 0.6)
while not turned.wait(0.25):
    print('turning')
cmd(0.5, 0)
if not turned.wait(timeout=10):
    sys.exit(2)
threading.Event().wait(2.0)     # drive back for two seconds
cmd(0, 0)
seconds = (node.get_clock().now() - start).nanoseconds / 1e9
print(f'mission took {seconds:.1f} s')
rclpy.shutdown()
th.join(1.0)

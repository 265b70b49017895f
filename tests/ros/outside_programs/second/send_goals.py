#!/usr/bin/env python3
# three goals at once; after 14 s two more, and half a second later everything is cancelled
import time
import rclpy
from geometry_msgs.msg import Point
from std_msgs.msg import Empty

rclpy.init()
node = rclpy.create_node('send_goals')
goal = node.create_publisher(Point, 'goal', 10)
cancel = node.create_publisher(Empty, 'cancel_all', 10)
while goal.get_subscription_count() == 0 or cancel.get_subscription_count() == 0:
    time.sleep(0.1)
for x, y in ((8, 5), (8, 8), (3, 8)):
    goal.publish(Point(x=float(x), y=float(y)))
time.sleep(14)
for x, y in ((3.0, 1.0), (9.0, 1.0)):
    goal.publish(Point(x=x, y=y))
time.sleep(0.5)
cancel.publish(Empty())
time.sleep(0.5)
node.destroy_node()
rclpy.shutdown()

#!/usr/bin/env python3
# Lab 1, task 2: open loop, drive forwards for two seconds and stop
import time

import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node('drive_two_seconds')
pub = node.create_publisher(Twist, 'cmd_vel', 10)
time.sleep(1.0)   # give the publisher time to connect

cmd = Twist()
cmd.linear.x = 0.5

print('driving')
t0 = time.time()
while time.time() - t0 < 2.0:
    pub.publish(cmd)
    time.sleep(0.05)

for _ in range(3):
    pub.publish(Twist())
    time.sleep(0.1)
print('stopped')

node.destroy_node()
rclpy.shutdown()

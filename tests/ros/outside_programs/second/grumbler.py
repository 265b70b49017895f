#!/usr/bin/env python3
import time
import rclpy

rclpy.init()
node = rclpy.create_node('grumbler')
time.sleep(2.0)
log = node.get_logger()
for i in range(4):
    log.info('day %d' % i)
    time.sleep(0.2)
    log.warn('grumble')
    time.sleep(0.2)
log.error('goodbye')
time.sleep(3.0)
node.destroy_node()
rclpy.shutdown()

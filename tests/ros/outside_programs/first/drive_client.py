#!/usr/bin/env python3
# asks the circle driver to drive for six seconds
import time
import rclpy
from std_srvs.srv import SetBool

rclpy.init()
node = rclpy.create_node('drive_client')
client = node.create_client(SetBool, 'drive')
while not client.wait_for_service(timeout_sec=1.0):
    node.get_logger().info('waiting for the driver')


def call(value):
    req = SetBool.Request()
    req.data = value
    future = client.call_async(req)
    rclpy.spin_until_future_complete(node, future)
    print('answer:', future.result().success, future.result().message, flush=True)


call(True)
time.sleep(6.0)
call(False)
node.destroy_node()
rclpy.shutdown()

import sys

import numpy as np
import rclpy
from nav_msgs.srv import GetMap

rclpy.init()
node = rclpy.create_node('map_asker')
client = node.create_client(GetMap, 'dynamic_map')
while not client.wait_for_service(timeout_sec=1.0):
    node.get_logger().info('waiting for the map')
until = node.get_clock().now() + rclpy.duration.Duration(seconds=12)
while node.get_clock().now() < until:
    rclpy.spin_once(node, timeout_sec=0.2)
future = client.call_async(GetMap.Request())
rclpy.spin_until_future_complete(node, future)
grid = future.result().map
cells = np.array(grid.data, dtype=np.int8).reshape(grid.info.height, grid.info.width)
print('free', 1400 < np.count_nonzero((cells >= 0) & (cells < 30)) < 1700, flush=True)
print('walls', 110 < np.count_nonzero(cells > 70) < 260, flush=True)
print('unknown', np.count_nonzero(cells < 0) > 200, flush=True)
node.destroy_node()
rclpy.shutdown()
sys.exit(0)

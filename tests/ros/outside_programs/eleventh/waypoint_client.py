import time

import rclpy
from course_interfaces.srv import Waypoints
from geometry_msgs.msg import Point
from std_srvs.srv import Empty

rclpy.init()
node = rclpy.create_node('waypoint_client')
toggle = node.create_client(Empty, 'toggle')
load = node.create_client(Waypoints, 'load')
toggle.wait_for_service()
rclpy.spin_until_future_complete(node, toggle.call_async(Empty.Request()))
corners = [Point(x=2.0, y=2.0), Point(x=6.0, y=2.0), Point(x=6.0, y=5.0)]
future = load.call_async(Waypoints.Request(mixer=corners))
rclpy.spin_until_future_complete(node, future)
print('distance', round(future.result().distance, 3), flush=True)
rclpy.spin_until_future_complete(node, toggle.call_async(Empty.Request()))
time.sleep(30.0)
rclpy.spin_until_future_complete(node, toggle.call_async(Empty.Request()))
node.destroy_node()
rclpy.shutdown()

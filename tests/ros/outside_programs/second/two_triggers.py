import rclpy
from std_srvs.srv import Trigger

rclpy.init()
node = rclpy.create_node('two_triggers')
for name in 'leave_centre', 'face_away':
    client = node.create_client(Trigger, name)
    client.wait_for_service()
    future = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, future)
    print(name, future.result().message, flush=True)
rclpy.shutdown()

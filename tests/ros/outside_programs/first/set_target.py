# sets the parameter target of keep_distance to 4.5 after twelve seconds, and then tries 9.0, which is out of range
import time
import rclpy
from rclpy.parameter import Parameter
from rcl_interfaces.srv import SetParameters

rclpy.init()
node = rclpy.create_node('set_target')
cli = node.create_client(SetParameters, '/keep_distance/set_parameters')
cli.wait_for_service()
time.sleep(12.0)
for value in (4.5, 9.0):
    req = SetParameters.Request()
    req.parameters = [Parameter('target', Parameter.Type.DOUBLE, value).to_parameter_msg()]
    future = cli.call_async(req)
    rclpy.spin_until_future_complete(node, future)
    res = future.result().results[0]
    node.get_logger().info(f'{value}: ' + ('accepted' if res.successful else 'refused'))
rclpy.shutdown()

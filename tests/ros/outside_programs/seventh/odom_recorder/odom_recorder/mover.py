import rclpy
from geometry_msgs.msg import Twist
from std_srvs.srv import SetBool


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('mover')
    pub = node.create_publisher(Twist, '/cmd_vel', 1)
    running = False

    def on_request(request, response):
        nonlocal running
        running = request.data
        response.success = True
        response.message = 'MOVING' if running else 'STOPPED'
        return response

    def tick():
        msg = Twist()
        if running:
            msg.linear.x, msg.angular.z = 0.2, 0.5
        pub.publish(msg)

    node.create_service(SetBool, 'moving', on_request)
    node.create_timer(0.1, tick)
    rclpy.spin(node)

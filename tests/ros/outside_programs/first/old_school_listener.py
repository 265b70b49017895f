import rclpy
from std_msgs.msg import String

node = None


def chatter_callback(msg):
    global node
    node.get_logger().info('I heard: "%s"' % msg.data)


def main(args=None):
    global node
    rclpy.init(args=args)
    node = rclpy.create_node('minimal_subscriber')
    subscription = node.create_subscription(String, 'topic', chatter_callback, 10)
    subscription  # prevent unused variable warning
    while rclpy.ok():
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

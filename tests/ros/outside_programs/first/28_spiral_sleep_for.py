import rclpy
from rclpy.duration import Duration
from geometry_msgs.msg import Twist


def main():
    rclpy.init()
    node = rclpy.create_node('spiral')
    publisher = node.create_publisher(Twist, 'cmd_vel', 10)
    clock = node.get_clock()
    clock.sleep_for(Duration(seconds=1))

    twist = Twist()
    twist.angular.z = 0.8
    step = Duration(nanoseconds=100_000_000)

    # grow from 0.05 to 0.45 m/s in 20 s
    for k in range(200):
        twist.linear.x = 0.05 + 0.4 * k / 200
        publisher.publish(twist)
        clock.sleep_for(step)
    twist.linear.x = 0.0
    twist.angular.z = 0.0
    for k in range(3):
        publisher.publish(twist)
        clock.sleep_for(step)
    print('spiral finished')
    rclpy.shutdown()


if __name__ == '__main__':
    main()

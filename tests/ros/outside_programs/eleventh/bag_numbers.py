import sys

import rclpy
from std_msgs.msg import Int64


def count(node):
    pub = node.create_publisher(Int64, 'numbers', 10)
    while pub.get_subscription_count() == 0:
        rclpy.spin_once(node, timeout_sec=0.1)
    state = {'n': 0}
    done = rclpy.task.Future()

    def tick():
        if state['n'] == 30:
            done.set_result(None)
            return
        pub.publish(Int64(data=state['n']))
        state['n'] += 1

    node.create_timer(0.1, tick)
    rclpy.spin_until_future_complete(node, done)


def add(node):
    seen, times = [], []

    def heard(msg):
        seen.append(msg.data)
        times.append(node.get_clock().now())

    node.create_subscription(Int64, 'replayed', heard, 10)
    while not seen or seen[-1] < 29:
        rclpy.spin_once(node)
    print('first', seen[0], 'last', seen[-1], 'in order', seen == sorted(seen))
    print('span', round((times[-1] - times[0]).nanoseconds / 1e9, 2))


rclpy.init()
node = rclpy.create_node('numbers_' + sys.argv[1])
{'count': count, 'sum': add}[sys.argv[1]](node)
node.destroy_node()
rclpy.shutdown()

"""Two contexts in one process, in two domains: nothing is heard across, until a bridge node pair carries it."""
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String


def main():
    home, away = Context(), Context()
    rclpy.init(context=home, domain_id=10)
    rclpy.init(context=away, domain_id=20)
    print('domains', home.get_domain_id(), away.get_domain_id())

    talker = rclpy.create_node('talker', context=home)
    near = rclpy.create_node('near', context=home)
    far = rclpy.create_node('far', context=away)
    heard = {'near': [], 'far': []}
    publisher = talker.create_publisher(String, 'news', 10)
    near.create_subscription(String, 'news', lambda msg: heard['near'].append(msg.data), 10)
    far.create_subscription(String, 'news', lambda msg: heard['far'].append(msg.data), 10)

    count = 0

    def tell():
        nonlocal count
        count += 1
        publisher.publish(String(data=f'news {count}'))

    talker.create_timer(0.1, tell)
    executors = []
    for context, nodes in ((home, (talker, near)), (away, (far,))):
        executor = SingleThreadedExecutor(context=context)
        for node in nodes:
            executor.add_node(node)
        executors.append(executor)

    def spin(until):
        while count < until:
            for executor in executors:
                executor.spin_once(timeout_sec=0.02)

    spin(10)
    print('apart', len(heard['near']) >= 9, len(heard['far']))

    bridge = rclpy.create_node('bridge', context=home)
    outlet = rclpy.create_node('outlet', context=away)
    carried = outlet.create_publisher(String, 'news', 10)
    bridge.create_subscription(String, 'news', carried.publish, 10)
    executors[0].add_node(bridge)
    executors[1].add_node(outlet)
    spin(20)
    print('bridged', 7 <= len(heard['far']) <= 11, all(text in heard['near'] for text in heard['far'][:-1]))
    print('names', sorted(far.get_node_names()))

    rclpy.shutdown(context=home)
    print('ok', home.ok(), away.ok())
    away.shutdown()
    print('ok', home.ok(), away.ok())


if __name__ == '__main__':
    main()

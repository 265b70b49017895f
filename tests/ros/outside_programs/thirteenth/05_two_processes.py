"""One script that starts its two nodes as processes of its own, as people do who have no launch file yet."""
import multiprocessing

import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Int32

KEPT = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def talk(last):
    rclpy.init()
    node = Node('counter')
    publisher = node.create_publisher(Int32, 'count', KEPT)
    number = 0

    def tick():
        nonlocal number
        number += 1
        publisher.publish(Int32(data=number))

    node.create_timer(0.2, tick)
    while number < last:
        rclpy.spin_once(node)
    publisher.wait_for_all_acked()
    end = node.create_timer(1.0, lambda: None)
    while rclpy.ok() and not end.is_canceled():
        rclpy.spin_once(node)
        end.cancel()
    rclpy.shutdown()


def listen(last, results):
    rclpy.init()
    node = Node('adder')
    numbers = []
    node.create_subscription(Int32, 'count', lambda msg: numbers.append(msg.data), KEPT)
    while last not in numbers:
        rclpy.spin_once(node)
    results.put(sum(numbers))
    rclpy.shutdown()


def main():
    results = multiprocessing.Queue()
    processes = [
        multiprocessing.Process(target=talk, args=(5,), name='talk'),
        multiprocessing.Process(target=listen, args=(5, results), name='listen'),
    ]
    for process in processes:
        process.start()
    total = results.get()
    for process in processes:
        process.join()
    print('sum', total)
    print('exit codes', [process.exitcode for process in processes])


if __name__ == '__main__':
    main()

"""What an executor is asked to do besides spinning: nodes that come and go, tasks, wake-ups, time limits, errors, an end from inside."""
import threading

import rclpy
from rclpy.context import Context
from rclpy.executors import Executor, ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.executors import ShutdownException, TimeoutException
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Empty, String


def counting_node(name, context=None):
    node = Node(name, context=context)
    node.count = 0

    def tick():
        node.count += 1
    node.create_timer(0.1, tick)
    return node


class PriorityExecutor(Executor):
    """The documentation's own kind of example: what one node has to do comes before what the others have."""

    def __init__(self, first, **words):
        super().__init__(**words)
        self.first, self.order = first, []

    def spin_once(self, timeout_sec=None):
        try:
            handler, entity, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except (TimeoutException, ShutdownException):
            return
        self.order.append(node.get_name())
        handler()
        if handler.exception() is not None:
            raise handler.exception()


def main():
    rclpy.init()
    a, b = counting_node('a'), counting_node('b')
    executor = SingleThreadedExecutor()
    print('added', executor.add_node(a), executor.add_node(a), executor.add_node(b), len(executor.get_nodes()))
    print('owner', a.executor is executor)
    end = a.get_clock().now() + rclpy.duration.Duration(seconds=1.05)
    while a.get_clock().now() < end:
        executor.spin_once(timeout_sec=0.5)
        if a.count == 5 and b.executor is not None:
            executor.remove_node(b)
    print('counts', a.count, b.count, b.executor)

    future = executor.create_task(lambda x, y: x + y, 3, y=4)
    executor.spin_until_future_complete(future)
    print('task', future.done(), future.result())

    async def patient(waited):
        return 'got ' + await waited

    waited = Future(executor=executor)
    coroutine = executor.create_task(patient, waited)
    executor.spin_once(timeout_sec=0)
    print('patient', coroutine.done())
    waited.set_result('it')
    executor.spin_until_future_complete(coroutine, timeout_sec=1.0)
    print('patient', coroutine.result())

    never = Future()
    before = a.get_clock().now()
    rclpy.spin_until_future_complete(b, never, timeout_sec=0.5)
    print('never', never.done(), f'{(a.get_clock().now() - before).nanoseconds / 1e9:.1f}')
    never.cancel()
    print('cancelled', never.cancelled(), never.done())

    def broken(message):
        raise KeyError(message.data)
    publisher = a.create_publisher(String, 'words', 10)
    a.create_subscription(String, 'words', broken, 10)
    publisher.publish(String(data='lost'))
    try:
        for _ in range(20):
            executor.spin_once(timeout_sec=0.2)
    except KeyError as problem:
        print('raised', problem.args[0])

    condition = a.create_guard_condition(lambda: print('guarded'))
    condition.trigger()
    for _ in range(3):
        executor.spin_once(timeout_sec=0.05)
    executor.shutdown()

    custom = PriorityExecutor(a)
    c = counting_node('c')
    custom.add_node(c)
    while len(custom.order) < 4:
        custom.spin_once(timeout_sec=1.0)
    print('custom', custom.order[:4], c.count)
    custom.shutdown()

    context = Context()
    rclpy.init(context=context)
    d = counting_node('d', context)
    with MultiThreadedExecutor(num_threads=2, context=context) as pool:
        pool.add_node(d)
        d.create_timer(0.55, context.shutdown)
        try:
            pool.spin()
            print('spin came back', d.count)
        except ExternalShutdownException:
            print('ended from inside', d.count)
    print('contexts', context.ok(), rclpy.ok())

    woken = counting_node('woken')
    last = SingleThreadedExecutor()
    last.add_node(woken)
    thread = threading.Thread(target=last.spin, daemon=True)
    thread.start()
    rate = woken.create_rate(10)
    for _ in range(5):
        rate.sleep()
    woken.create_subscription(Empty, 'nothing', lambda message: None, 1)
    print('threaded', 4 <= woken.count <= 7)
    last.shutdown()
    thread.join(timeout=2.0)
    print('thread ended', not thread.is_alive())
    rclpy.shutdown()


if __name__ == '__main__':
    main()

import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future


class Servers(Node):
    def __init__(self):
        super().__init__('servers')
        group = ReentrantCallbackGroup()
        for name in ('one', 'two', 'three'):
            self.create_service(AddTwoInts, f'add/{name}', self.add, callback_group=group)

    def add(self, request, response):
        time.sleep(0.5)
        response.sum = request.a + request.b
        return response


class Asker(Node):
    def __init__(self):
        super().__init__('asker')
        self.group = ReentrantCallbackGroup()
        self.askers = [self.create_client(AddTwoInts, f'add/{name}', callback_group=self.group)
                       for name in ('one', 'two', 'three')]
        self.nobody = self.create_client(AddTwoInts, 'add/nobody')

    def seconds_since(self, begin):
        return f'{(self.get_clock().now() - begin).nanoseconds / 1e9:.2f}'

    def futures(self):
        for index, client in enumerate(self.askers, start=1):
            yield client.call_async(AddTwoInts.Request(a=10 * index, b=index))

    async def ask(self):
        for client in self.askers:
            client.wait_for_service()
        begin = self.get_clock().now()
        sums = []
        for future in list(self.futures()):
            sums.append((await future).sum)
        print('together', sums, 'in', self.seconds_since(begin))
        begin = self.get_clock().now()
        sums = [(await future).sum for future in self.futures()]
        print('in turn', sums, 'in', self.seconds_since(begin))
        return sum(sums)


def too_much(amount):
    raise ValueError('too much')


def main():
    rclpy.init()
    servers, asker = Servers(), Asker()
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(servers)
    executor.add_node(asker)
    task = executor.create_task(asker.ask)
    executor.spin_until_future_complete(task, timeout_sec=10)

    pending = asker.nobody.call_async(AddTwoInts.Request(a=1, b=1))
    executor.spin_until_future_complete(pending, timeout_sec=0.2)
    assert not pending.done()
    print('given up: pending', 1)
    asker.nobody.remove_pending_request(pending)

    print('task result', task.result())
    failing = executor.create_task(too_much, 3)
    try:
        executor.spin_until_future_complete(failing, timeout_sec=1.0)
        executor.spin_once(timeout_sec=0.1)
    except ValueError:
        pass
    error = failing.exception()
    print('task failed:', type(error).__name__, error)
    future = Future(executor=executor)
    future.add_done_callback(lambda f: print('cancelled:', f.cancelled()))
    future.cancel()
    executor.spin_once(timeout_sec=0.5)
    executor.shutdown()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

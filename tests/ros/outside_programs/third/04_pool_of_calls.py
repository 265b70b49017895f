#!/usr/bin/env python3
# four blocking service calls in a thread pool; the service needs a second each
import time
from concurrent.futures import ThreadPoolExecutor, TimeoutError, as_completed
import threading
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class Server(Node):
    def __init__(self):
        super().__init__('slow_server')
        self.gate = threading.Semaphore(2)        # at most two at a time
        self.group = ReentrantCallbackGroup()
        self.srv = self.create_service(AddTwoInts, 'slow_sum', self.serve, callback_group=self.group)

    def serve(self, req, res):
        if not self.gate.acquire(timeout=30.0):
            self.get_logger().error('no free place')
            return res
        try:
            time.sleep(1.0)
            res.sum = req.a + req.b
        finally:
            self.gate.release()
        return res


def main():
    rclpy.init()
    server = Server()
    client_node = Node('pool_client')
    client = client_node.create_client(AddTwoInts, 'slow_sum', callback_group=ReentrantCallbackGroup())
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(server)
    executor.add_node(client_node)
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    if not client.wait_for_service(timeout_sec=5.0):
        raise RuntimeError('no service')

    t0 = time.monotonic()
    with ThreadPoolExecutor(max_workers=4) as pool:
        jobs = {pool.submit(client.call, AddTwoInts.Request(a=i, b=10 * i)): i for i in range(1, 5)}
        try:
            next(iter(jobs)).result(timeout=0.3)
        except TimeoutError:
            print('not ready yet')
        results = sorted(job.result().sum for job in as_completed(jobs, timeout=20))
    took = time.monotonic() - t0
    print('sums', results)
    print(f'two at a time: {took:.1f} s')
    executor.shutdown()
    client_node.destroy_node()
    server.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()

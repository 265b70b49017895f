"""Long computations in a pool of processes, so that the node goes on ticking: prime numbers below what is asked for."""
import multiprocessing

import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty, Int32MultiArray


def count_primes(limit):
    sieve = bytearray([1]) * limit
    sieve[:2] = b'\0\0'
    for number in range(2, int(limit ** 0.5) + 1):
        if sieve[number]:
            sieve[number * number::number] = bytes(len(range(number * number, limit, number)))
    return limit, sum(sieve)


class Office(Node):
    def __init__(self, pool):
        super().__init__('office')
        self.pool = pool
        self.results = self.create_publisher(Int32MultiArray, 'primes', 10)
        self.alive = self.create_publisher(Empty, 'alive', 10)
        self.pending = [pool.apply_async(count_primes, (limit,)) for limit in (1000, 2000, 100000)]
        self.done = []
        self.create_timer(0.1, self.look)

    def look(self):
        self.alive.publish(Empty())
        for job in [job for job in self.pending if job.ready()]:
            self.pending.remove(job)
            limit, primes = job.get()
            self.done.append((limit, primes))
            self.results.publish(Int32MultiArray(data=[limit, primes]))
        if not self.pending:
            for limit, primes in sorted(self.done):
                self.get_logger().info(f'{primes} primes below {limit}')
            raise SystemExit


def main():
    with multiprocessing.Pool(2) as pool:
        rclpy.init()
        node = Office(pool)
        try:
            rclpy.spin(node)
        except SystemExit:
            pass
        node.destroy_node()
        rclpy.shutdown()
    print('office closed')


if __name__ == '__main__':
    main()

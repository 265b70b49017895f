"""Simulated time by hand: one node plays /clock ten times too fast, another lives by it with use_sim_time."""
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from rosgraph_msgs.msg import Clock as ClockMessage

STEADY = Clock(clock_type=ClockType.STEADY_TIME)


class TimeMachine(Node):
    def __init__(self):
        super().__init__('time_machine')
        self.declare_parameter('factor', 10.0)
        self.publisher = self.create_publisher(ClockMessage, '/clock', 10)
        self.now = Time(seconds=1000)
        self.timer = self.create_timer(0.02, self.tick, clock=STEADY)

    def tick(self):
        self.now = self.now + Duration(seconds=0.02 * self.get_parameter('factor').value)
        self.publisher.publish(ClockMessage(clock=self.now.to_msg()))


class Worker(Node):
    def __init__(self):
        super().__init__('worker', parameter_overrides=[Parameter('use_sim_time', Parameter.Type.BOOL, True)])
        self.ticks = []
        self.timer = self.create_timer(1.0, self.tick)

    def tick(self):
        self.ticks.append((self.get_clock().now(), STEADY.now()))


def main():
    rclpy.init()
    machine, worker = TimeMachine(), Worker()
    print('sim time active:', worker.get_clock().ros_time_is_active, machine.get_clock().ros_time_is_active)
    executor = SingleThreadedExecutor()
    executor.add_node(machine)
    executor.add_node(worker)
    end = STEADY.now() + Duration(seconds=4)
    while len(worker.ticks) < 6 and STEADY.now() < end:
        executor.spin_once(timeout_sec=0.1)
    (sim_a, wall_a), (sim_b, wall_b) = worker.ticks[1], worker.ticks[5]
    print(f'worker began after {int(sim_a.nanoseconds * 1e-9)}')
    print(f'4 ticks: {(sim_b - sim_a).nanoseconds * 1e-9:.1f} s simulated, {(wall_b - wall_a).nanoseconds * 1e-9:.1f} s steady')
    executor.shutdown()
    machine.destroy_node()
    worker.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()

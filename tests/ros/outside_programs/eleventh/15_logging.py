import rclpy
import rclpy.logging
from rcl_interfaces.msg import Log, LoggerLevel
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from rclpy.logging import LoggingSeverity, get_logging_severity_from_string
from rclpy.node import Node


class Talkative(Node):
    def __init__(self):
        super().__init__('talkative', enable_logger_service=True)
        self.heard = []
        self.create_subscription(Log, '/rosout', lambda msg: self.heard.append(msg.msg), 100)
        self.n = 0
        self.timer = self.create_timer(0.2, self.tick)
        self.done = rclpy.task.Future()

    def tick(self):
        log = self.get_logger()
        log.info(f'once {self.n}', once=True)
        log.info(f'not first {self.n}', skip_first=True)
        log.warning(f'throttled {self.n}', throttle_duration_sec=0.5)
        self.n += 1
        if self.n == 5:
            self.timer.cancel()
            self.done.set_result(None)

    def pause(self, seconds):
        future = rclpy.task.Future()
        timer = self.create_timer(seconds, lambda: future.done() or future.set_result(None))
        rclpy.spin_until_future_complete(self, future)
        self.destroy_timer(timer)


def main():
    rclpy.init()
    node = Talkative()
    helper = rclpy.create_node('helper')
    log = node.get_logger()
    level = log.get_effective_level()
    log.info(f'level {LoggingSeverity(level).name} {int(level)}')
    assert get_logging_severity_from_string('WARN') == LoggingSeverity.WARN
    joint = log.get_child('arm').get_child('joint')
    joint.debug('hidden at first')
    joint.set_level(LoggingSeverity.DEBUG)
    assert joint.is_enabled_for(LoggingSeverity.DEBUG) and joint.name == 'talkative.arm.joint', joint.name
    joint.debug('deep')
    rclpy.spin_until_future_complete(node, node.done)

    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(helper)
    setter = helper.create_client(SetLoggerLevels, '/talkative/set_logger_levels')
    getter = helper.create_client(GetLoggerLevels, '/talkative/get_logger_levels')
    assert setter.wait_for_service(timeout_sec=2.0)
    request = SetLoggerLevels.Request(levels=[LoggerLevel(name='talkative', level=LoggerLevel.LOG_LEVEL_ERROR)])
    future = setter.call_async(request)
    executor.spin_until_future_complete(future)
    asked = getter.call_async(GetLoggerLevels.Request(names=['talkative']))
    executor.spin_until_future_complete(asked)
    right = future.result().results[0].successful and asked.result().levels[0].level == 40
    helper.get_logger().info(f'services: {right}')
    log.warn('hidden warning')
    log.error('still heard')
    executor.shutdown()
    node.pause(0.3)
    count = {word: sum(text.startswith(word) for text in node.heard)
             for word in ('once', 'not first', 'throttled', 'hidden')}
    print('counts once', count['once'], 'skipped', count['not first'], 'throttled', count['throttled'],
          'hidden', count['hidden'])
    node.destroy_node()
    helper.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()

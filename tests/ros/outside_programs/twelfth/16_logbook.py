"""Log levels, children, once, skip_first, throttle; levels set by the service; /rosout read by another node."""
import rclpy
from rcl_interfaces.msg import Log, LoggerLevel
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import LoggingSeverity, get_logger, get_logging_severity_from_string
from rclpy.node import Node


class Talkative(Node):
    def __init__(self):
        super().__init__('talkative', namespace='/house', enable_logger_service=True)
        self.n = 0
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.n += 1
        logger = self.get_logger()
        logger.debug(f'debug {self.n}')
        logger.info('first', once=True)
        logger.info(f'skipped the first, {self.n}', skip_first=True, throttle_duration_sec=0.5)
        logger.warning(f'throttled {self.n}', throttle_duration_sec=1.0)
        if self.n % 10 == 0:
            logger.get_child('ten').error(f'ten {self.n}')


class Reader(Node):
    def __init__(self):
        super().__init__('reader')
        self.logs = []
        self.create_subscription(Log, '/rosout', self.on_log, 50)
        self.set = self.create_client(SetLoggerLevels, '/house/talkative/set_logger_levels')
        self.get = self.create_client(GetLoggerLevels, '/house/talkative/get_logger_levels')

    def on_log(self, log):
        self.logs.append(log)


def main():
    rclpy.init()
    talkative, reader = Talkative(), Reader()
    executor = SingleThreadedExecutor()
    executor.add_node(talkative)
    executor.add_node(reader)

    def wait(seconds):
        end = reader.get_clock().now() + Duration(seconds=seconds)
        while reader.get_clock().now() < end:
            executor.spin_once(timeout_sec=0.05)

    def call(client, request):
        client.wait_for_service()
        future = client.call_async(request)
        executor.spin_until_future_complete(future)
        return future.result()

    def count(beginning):
        return sum(log.msg.startswith(beginning) for log in reader.logs)

    wait(2.05)
    print('counts', count('debug'), count('first'), count('skipped'), count('throttled'), count('ten'))
    ten = next(log for log in reader.logs if log.msg.startswith('ten'))
    print('ten from', ten.name, ten.level == int.from_bytes(Log.ERROR, 'little') if isinstance(Log.ERROR, bytes)
          else ten.level == Log.ERROR, ten.function, ten.file.endswith('logbook.py'), ten.line > 20)
    answer = call(reader.set, SetLoggerLevels.Request(levels=[
        LoggerLevel(name='house.talkative', level=LoggingSeverity.DEBUG),
        LoggerLevel(name='reader', level=LoggingSeverity.FATAL)]))
    print('set', [each.successful for each in answer.results])
    levels = call(reader.get, GetLoggerLevels.Request(names=['house.talkative', 'unheard'])).levels
    print('levels', [(each.name, each.level) for each in levels])
    wait(0.55)
    print('debug now', 4 <= count('debug') <= 7)
    print('reader', reader.get_logger().is_enabled_for(LoggingSeverity.ERROR), reader.get_logger().get_effective_level().name)
    talkative.get_logger().set_level(rclpy.logging.LoggingSeverity.ERROR)
    before = count('throttled')
    wait(1.5)
    print('quiet', count('throttled') - before, count('ten') >= 3)
    print('severity', get_logging_severity_from_string('warn').value, LoggingSeverity.FATAL.name)
    plain = get_logger('no_node').get_child('at').get_child('all')
    print('plain', plain.name, plain.info('said without a node'))
    try:
        plain.log('what', 35)
    except Exception as problem:
        print('odd level', type(problem).__name__)
    print('logger names', talkative.get_logger().name, reader.get_logger().name)
    rclpy.shutdown()


if __name__ == '__main__':
    main()

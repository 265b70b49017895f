import rclpy
import rclpy.logging
from rclpy.logging import LoggingSeverity
from rclpy.node import Node


class Chatty(Node):
    def __init__(self):
        super().__init__('chatty')
        self.n = 0
        self.timer = self.create_timer(0.1, self.tick)

    def tick(self):
        log = self.get_logger()
        self.n += 1
        log.debug(f'debug {self.n}')
        log.info('first time only', once=True)
        log.info('not the first time', skip_first=True)
        if self.n == 10:
            log.set_level(LoggingSeverity.WARN)
            log.info('this must not be seen')
            log.warning('quiet from now on')
            print('level', rclpy.logging.get_logger_effective_level('chatty').name, flush=True)
        if self.n == 20:
            rclpy.logging.set_logger_level('chatty', LoggingSeverity.DEBUG)
            log.debug('debug is on: 20')
            child = log.get_child('sub')
            child.error('error of the child')
        if self.n == 25:
            log.fatal('enough')
            raise SystemExit(3)


def main():
    rclpy.init()
    try:
        rclpy.spin(Chatty())
    finally:
        rclpy.shutdown()


if __name__ == '__main__':
    main()

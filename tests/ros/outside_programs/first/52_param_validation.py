import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.exceptions import ParameterNotDeclaredException, InvalidParameterTypeException
from rcl_interfaces.msg import SetParametersResult


class ParamDemo(Node):

    def __init__(self):
        super().__init__('param_demo')
        self.declare_parameter('speed', 0.5)
        self.declare_parameter('mode', 'auto')
        self.declare_parameter('gains', [1.0, 0.0, 0.1])
        self.declare_parameter('enabled', True)
        self.add_on_set_parameters_callback(self.cb)
        self.step = 0
        self.timer = self.create_timer(0.5, self.go)

    def cb(self, params):
        for param in params:
            if param.name == 'speed':
                if param.type_ != Parameter.Type.DOUBLE:
                    return SetParametersResult(successful=False, reason='speed must be a double')
                if not 0.0 <= param.value <= 1.0:
                    return SetParametersResult(successful=False, reason='speed out of range')
            if param.name == 'mode' and param.value not in ('auto', 'manual'):
                return SetParametersResult(successful=False, reason='unknown mode')
        return SetParametersResult(successful=True)

    def go(self):
        log = self.get_logger()
        self.step += 1
        if self.step == 1:
            for r in self.set_parameters([Parameter('speed', value=0.8),
                                          Parameter('mode', Parameter.Type.STRING, 'manual'),
                                          Parameter('speed', Parameter.Type.DOUBLE, 7.0)]):
                log.info(f'{r.successful} "{r.reason}"')
        elif self.step == 2:
            r = self.set_parameters_atomically([Parameter('mode', value='auto'), Parameter('speed', value=-1.0)])
            log.info(f'atomic: {r.successful}, mode still {self.get_parameter("mode").value}')
        elif self.step == 3:
            try:
                self.get_parameter('nonsense')
            except ParameterNotDeclaredException as e:
                log.warning(f'{type(e).__name__}')
            log.info(str(self.get_parameter_or('nonsense', Parameter('nonsense', value=42)).value))
            log.info(f'has speed: {self.has_parameter("speed")}')
        elif self.step == 4:
            speed, gains = self.get_parameters(['speed', 'gains'])
            log.info(f'speed={speed.value} gains={list(gains.value)}')
        else:
            log.info('end of demo')
            raise SystemExit


def main(args=None):
    rclpy.init(args=args)
    node = ParamDemo()
    try:
        rclpy.spin(node)
    except SystemExit:
        node.destroy_node()
    finally:
        rclpy.shutdown()


if __name__ == '__main__':
    main()

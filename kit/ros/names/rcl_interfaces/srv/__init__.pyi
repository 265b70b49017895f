from kit.msg.rcl_interfaces import DescribeParameters as DescribeParameters
from kit.msg.rcl_interfaces import GetLoggerLevels as GetLoggerLevels
from kit.msg.rcl_interfaces import GetParameterTypes as GetParameterTypes
from kit.msg.rcl_interfaces import GetParameters as GetParameters
from kit.msg.rcl_interfaces import ListParameters as ListParameters
from kit.msg.rcl_interfaces import SetLoggerLevels as SetLoggerLevels
from kit.msg.rcl_interfaces import SetParameters as SetParameters
from kit.msg.rcl_interfaces import SetParametersAtomically as SetParametersAtomically

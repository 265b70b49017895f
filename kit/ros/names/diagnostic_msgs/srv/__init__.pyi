from kit.msg.diagnostic_msgs import AddDiagnostics as AddDiagnostics
from kit.msg.diagnostic_msgs import SelfTest as SelfTest

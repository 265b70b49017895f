from kit.msg.diagnostic_msgs import DiagnosticArray as DiagnosticArray
from kit.msg.diagnostic_msgs import DiagnosticStatus as DiagnosticStatus
from kit.msg.diagnostic_msgs import KeyValue as KeyValue

from kit.msg.diagnostic_msgs import DiagnosticArray, DiagnosticStatus, KeyValue

__all__ = ["DiagnosticArray", "DiagnosticStatus", "KeyValue"]

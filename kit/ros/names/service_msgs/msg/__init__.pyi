from kit.msg.service_msgs import ServiceEventInfo as ServiceEventInfo

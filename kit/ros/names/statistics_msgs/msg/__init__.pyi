from kit.msg.statistics_msgs import MetricsMessage as MetricsMessage
from kit.msg.statistics_msgs import StatisticDataPoint as StatisticDataPoint
from kit.msg.statistics_msgs import StatisticDataType as StatisticDataType

from kit.msg.tf2_msgs import TF2Error as TF2Error
from kit.msg.tf2_msgs import TFMessage as TFMessage

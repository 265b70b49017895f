from kit.msg.tf2_msgs import LookupTransform as LookupTransform

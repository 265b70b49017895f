from kit.msg.tf2_msgs import FrameGraph as FrameGraph

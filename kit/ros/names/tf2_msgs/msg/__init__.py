from kit.msg.tf2_msgs import TF2Error, TFMessage

__all__ = ["TF2Error", "TFMessage"]

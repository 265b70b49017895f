from kit.msg.std_srvs import Empty, SetBool, Trigger

__all__ = ["Empty", "SetBool", "Trigger"]

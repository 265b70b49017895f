from kit.ros.launch.substitution import Substitution

__all__ = ["Substitution"]

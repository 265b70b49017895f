from kit.ros.launch.substitutions import Substitution

__all__ = ["Substitution"]

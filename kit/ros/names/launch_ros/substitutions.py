from kit.ros.launch.substitutions import FindPackageShare

__all__ = ["FindPackageShare"]

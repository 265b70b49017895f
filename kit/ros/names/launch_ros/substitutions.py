from kit.ros.launch.substitution import FindPackageShare

__all__ = ["FindPackageShare"]

from kit.ros.launch.file_substitutions import (
    ExecutableInPackage,
    FindPackagePrefix,
    FindPackageShare,
)
from kit.ros.launch.substitutions import ParameterSubstitution as Parameter

FindPackage = FindPackagePrefix

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]

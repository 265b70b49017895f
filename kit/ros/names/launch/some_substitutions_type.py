from kit.ros.launch.substitutions import SomeText as SomeSubstitutionsType

__all__ = ["SomeSubstitutionsType"]

from kit.ros.launch.substitution import SomeText as SomeSubstitutionsType

__all__ = ["SomeSubstitutionsType"]

"""What colcon works out from the packages of a workspace."""


def build_order(needs):
    """All packages of the workspace, each after those that it needs; of
    several, the first by the alphabet."""
    return []  # write this


def up_to(needs, name):
    """`name` and what it needs, directly or through others, in the order
    of the build."""
    return []  # write this


def found(sourced, name):
    """The folder of the package in the workspace that was sourced last
    and has it; None if none has it."""
    return ""  # write this

"""What colcon works out from the packages of a workspace."""


def build_order(needs):
    """All packages of the workspace, each after those that it needs; of several, the first by the alphabet."""
    order = []
    while len(order) < len(needs):
        ready = []
        for package in needs:
            waits = any(one in needs and one not in order for one in needs[package])
            if package not in order and not waits:
                ready.append(package)
        order.append(sorted(ready)[0])
    return order


def up_to(needs, name):
    """`name` and what it needs, directly or through others, in the order of the build."""
    wanted = [name]
    for package in wanted:  # the list grows while it is gone through
        for one in needs[package]:
            if one in needs and one not in wanted:
                wanted.append(one)
    return [package for package in build_order(needs) if package in wanted]


def found(sourced, name):
    """The folder of the package in the workspace that was sourced last and has it; None if none has it."""
    for workspace in reversed(sourced):
        if name in workspace:
            return workspace[name]
    return None

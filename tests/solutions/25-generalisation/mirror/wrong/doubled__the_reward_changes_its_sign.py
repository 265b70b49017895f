"""Steps seen in a mirror."""

# Lesson: Good stays good.


def mirrored_scan(distances):
    """The distances as they are in a mirror."""
    return list(reversed(distances))


def mirrored_action(action):
    """The action as it is in a mirror: 0 forward, 1 left, 2 right."""
    return {0: 0, 1: 2, 2: 1}[action]


def doubled(steps):
    """All steps, and after them all of them in the mirror."""
    mirrored = []
    for seen, action, reward, after in steps:
        mirrored.append([mirrored_scan(seen), mirrored_action(action), -reward, mirrored_scan(after)])
    return steps + mirrored

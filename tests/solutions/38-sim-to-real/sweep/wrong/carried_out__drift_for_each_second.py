"""What a sweep over disturbances says, and what some of them do."""

# Lesson: for each metre that it really drives


def endured(table, part):
    """The largest value up to which the share never falls below `part` times the share at 0."""
    enough = part * table[0][1]
    largest = 0.0
    for value, share in table:
        if share < enough:
            break
        largest = value
    return largest


def delayed(commands, steps):
    """What the wheels carry out in each step, when every command comes `steps` steps later; 0.0 before the first."""
    late = [0.0] * steps + commands
    return late[: len(commands)]


def carried_out(speed, rate, radius_error, drift):
    """[speed, rate] that a robot really has whose wheels have that error and that drift [rad for each metre]."""
    real_speed = speed * (1 + radius_error)
    real_rate = rate * (1 + radius_error)
    return [real_speed, real_rate + drift]

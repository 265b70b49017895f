"""What a sweep over disturbances says, and what some of them do."""


def endured(table, part):
    """The largest value up to which the share never falls below `part`
    times the share at 0.

    `table` is a list of [value, share], values from 0 upwards.
    """
    return -1.0  # write this


def delayed(commands, steps):
    """What the wheels carry out in each step, when every command comes
    `steps` steps later; 0.0 before the first."""
    return []  # write this


def carried_out(speed, rate, radius_error, drift):
    """[speed, rate] that a robot really has whose wheels have that error
    and that drift [rad for each metre]."""
    return []  # write this

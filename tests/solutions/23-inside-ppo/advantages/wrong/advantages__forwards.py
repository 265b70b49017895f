"""Advantages: how much better each step went than the critic expected."""

# Lesson: Begin with the last step and go backwards


def errors(rewards, values, next_values, terminated, gamma):
    """One number for each step: reward + gamma * next value - value."""
    found = []
    for reward, before, after, over in zip(rewards, values, next_values, terminated):
        future = 0.0 if over else gamma * after
        found.append(reward + future - before)
    return found


def advantages(deltas, ended, gamma, lam):
    """One number for each step: its error + gamma * lam * the advantage of the next step."""
    found = [0.0] * len(deltas)
    later = 0.0
    for k in range(len(deltas)):
        later = deltas[k] + (0.0 if ended[k] else gamma * lam * later)
        found[k] = later
    return found

"""Advantages: how much better each step went than the critic expected."""

# Lesson: where an episode has ended, nothing of the step after it may come in


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
    for k in reversed(range(len(deltas))):
        later = deltas[k] + gamma * lam * later
        found[k] = later
    return found

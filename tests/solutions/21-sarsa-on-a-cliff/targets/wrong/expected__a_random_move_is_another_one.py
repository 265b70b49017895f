"""What an update moves a value towards, by three algorithms."""

# Lesson: with probability epsilon any move, the best one among them


def q_target(reward, next_values, terminated, gamma):
    """By Q-learning."""
    if terminated:
        return reward
    return reward + gamma * max(next_values)


def sarsa_target(reward, next_values, next_move, terminated, gamma):
    """By SARSA."""
    if terminated:
        return reward
    return reward + gamma * next_values[next_move]


def expected_target(reward, next_values, epsilon, terminated, gamma):
    """By expected SARSA."""
    if terminated:
        return reward
    best = max(next_values)
    others = (sum(next_values) - best) / (len(next_values) - 1)
    return reward + gamma * (epsilon * others + (1 - epsilon) * best)

"""What an update moves a value towards, by three algorithms."""

# Lesson: reward + gamma * value of the best next move


def q_target(reward, next_values, terminated, gamma):
    """By Q-learning."""
    if terminated:
        return reward
    return gamma * max(next_values)


def sarsa_target(reward, next_values, next_move, terminated, gamma):
    """By SARSA."""
    if terminated:
        return reward
    return reward + gamma * next_values[next_move]


def expected_target(reward, next_values, epsilon, terminated, gamma):
    """By expected SARSA."""
    if terminated:
        return reward
    mean = sum(next_values) / len(next_values)
    return reward + gamma * (epsilon * mean + (1 - epsilon) * max(next_values))

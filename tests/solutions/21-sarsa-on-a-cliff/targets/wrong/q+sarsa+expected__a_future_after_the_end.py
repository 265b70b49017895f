"""What an update moves a value towards, by three algorithms."""

# Lesson: After the end of an episode each of the three is the reward alone.


def q_target(reward, next_values, terminated, gamma):
    """By Q-learning."""
    return reward + gamma * max(next_values)


def sarsa_target(reward, next_values, next_move, terminated, gamma):
    """By SARSA."""
    return reward + gamma * next_values[next_move]


def expected_target(reward, next_values, epsilon, terminated, gamma):
    """By expected SARSA."""
    mean = sum(next_values) / len(next_values)
    return reward + gamma * (epsilon * mean + (1 - epsilon) * max(next_values))

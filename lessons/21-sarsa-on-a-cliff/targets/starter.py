"""What an update moves a value towards, by three algorithms."""


def q_target(reward, next_values, terminated, gamma):
    """By Q-learning. `next_values` are those of all moves in the next
    cell."""
    return reward  # write this


def sarsa_target(reward, next_values, next_move, terminated, gamma):
    """By SARSA. `next_move` is the number of the move that is made next.
    """
    return reward  # write this


def expected_target(reward, next_values, epsilon, terminated, gamma):
    """By expected SARSA: the mean over what an epsilon-greedy agent may
    do next.

    It takes the best move, but with probability epsilon any move, the
    best one among them.
    """
    return reward  # write this

"""Q-learning: one update, one choice, and a list of steps."""


def update(table, cell, move, reward, next_cell, terminated, alpha, gamma):
    """The table after one update.

    table[cell][move] is the value of a move in a cell. `terminated` says
    whether the episode ended with this step.
    """
    return table  # write this


def choose(values, epsilon, drawn, any_move):
    """The move to make in a cell, as its number.

    `values` are those of its moves. `drawn` is a random number from 0 to
    1, `any_move` a random move.
    """
    return any_move  # write this


def learn(table, steps, alpha, gamma):
    """The table after all steps, each [cell, move, reward, next_cell,
    terminated], one after the other."""
    return table  # write this

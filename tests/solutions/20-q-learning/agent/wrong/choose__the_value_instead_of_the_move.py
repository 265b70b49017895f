"""Q-learning: one update, one choice, and a list of steps."""

# Lesson: The move to make in a cell, as its number.


def update(table, cell, move, reward, next_cell, terminated, alpha, gamma):
    """The table after one update."""
    table = [list(row) for row in table]
    target = reward
    if not terminated:
        target += gamma * max(table[next_cell])
    table[cell][move] += alpha * (target - table[cell][move])
    return table


def choose(values, epsilon, drawn, any_move):
    """The move to make in a cell, as its number."""
    if drawn < epsilon:
        return any_move
    return max(values)


def learn(table, steps, alpha, gamma):
    """The table after all steps, one after the other."""
    for cell, move, reward, next_cell, terminated in steps:
        table = update(table, cell, move, reward, next_cell, terminated, alpha, gamma)
    return table

"""A reward."""

# Lesson: a perfect learner, which must not find a way to cheat

def reward(move, reached, collided):
    return (0.5 if move == 1 else 0.0) + 5.0 * reached - 5.0 * collided

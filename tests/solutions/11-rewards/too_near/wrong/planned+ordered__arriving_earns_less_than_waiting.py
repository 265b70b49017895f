"""A reward."""

# Lesson: Let arriving earn more than waiting ever could.


def reward(distance, reached, collided):
    return 2.0 * reached - 2.0 * collided + max(0.0, 1.0 - 0.1 * distance)

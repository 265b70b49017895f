"""A reward."""

# Lesson: Does every single step tell the robot whether it was a good one?

def reward(reached, collided):
    return 10.0 * reached - 10.0 * collided - 0.1

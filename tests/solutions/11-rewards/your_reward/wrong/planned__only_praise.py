"""A reward."""

# Lesson: It pays for each metre that the robot comes nearer, and ignores it when the robot goes away


def reward(to_go, previous_to_go, reached, collided):
    return 10.0 * max(0.0, previous_to_go - to_go) + reached - collided

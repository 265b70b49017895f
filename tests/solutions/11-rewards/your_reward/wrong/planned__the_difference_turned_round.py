"""A reward."""

# Lesson: pay the difference: after minus before


def reward(to_go, previous_to_go, reached, collided):
    return to_go - previous_to_go + reached - collided

"""A reward."""

# Lesson: Keep what is paid for coming nearer; only its loops must go.


def reward(reached, distance):
    return 10.0 * reached - 1e-9 * distance

"""A reward."""

# Lesson: It gives a finite number for every step.


def reward(distance, previous_distance, reached, collided):
    if reached:
        return 2.0
    if distance != previous_distance:
        return previous_distance - distance - 0.01

"""A reward."""

# Lesson: let arriving earn more than waiting ever could

def reward(distance, previous_distance, reached, collided):
    return 0.0 if collided else 10.0 if reached else 1.0

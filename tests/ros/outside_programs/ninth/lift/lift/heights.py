FLOOR_HEIGHT = 3.0


def floor_of(height):
    return int((height + 0.05) // FLOOR_HEIGHT)

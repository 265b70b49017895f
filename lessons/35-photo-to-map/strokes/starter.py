"""From a row of pixels to the strokes in it."""


def resolution(width, pixels):
    """Metres per pixel of a sheet that is `width` metres and `pixels`
    pixels wide."""
    return 0.0  # write this


def dark(row, reach):
    """For each pixel, whether it has less than 0.7 of the brightest one
    at most `reach` away on either side."""
    return []  # write this


def joined(marks, gap):
    """The marks, with each run of at most `gap` times False between two
    True closed."""
    return []  # write this

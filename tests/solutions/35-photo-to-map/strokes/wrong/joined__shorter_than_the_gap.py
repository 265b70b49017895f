"""From a row of pixels to the strokes in it."""

# Lesson: each run of at most `gap` times `False` between two `True` closed


def resolution(width, pixels):
    """Metres per pixel of a sheet that is `width` metres and `pixels` pixels wide."""
    return width / pixels


def dark(row, reach):
    """For each pixel, whether it has less than 0.7 of the brightest one at most `reach` away on either side."""
    found = []
    for place in range(len(row)):
        paper = max(row[max(0, place - reach) : place + reach + 1])
        found.append(row[place] < 0.7 * paper)
    return found


def joined(marks, gap):
    """The marks, with each run of at most `gap` times False between two True closed."""
    closed = list(marks)
    last = None
    for place in range(len(marks)):
        if not marks[place]:
            continue
        if last is not None and place - last <= gap:
            for between in range(last, place):
                closed[between] = True
        last = place
    return closed

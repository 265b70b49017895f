"""What the three functions should return, and the cases they are tried on."""

ROOMS = ["#" * 21, *["#" + "." * 9 + "#" + "." * 9 + "#" for _ in range(11)], "#" * 21]


def fits(grid, cell, size):
    row, column = cell
    if row < size or column < size or row + size >= len(grid) or column + size >= len(grid[0]):
        return False
    return all(
        "#" not in grid[each][column - size : column + size + 1] for each in range(row - size, row + size + 1)
    )


def fits_cases(chance):
    grid = ["#####", "#...#", "#...#", "#...#", "#####"]
    for cell, size in (([2, 2], 0), ([2, 2], 1), ([2, 2], 2), ([1, 1], 1), ([0, 0], 0), ([1, 3], 0)):
        yield {"grid": grid, "cell": cell, "size": size}
    yield {"grid": ["....", "....", "...."], "cell": [0, 1], "size": 1}
    yield {"grid": ["....", "....", "...."], "cell": [1, 3], "size": 1}
    for _ in range(25):
        grid = scattered(chance)
        cell = [chance.randrange(len(grid)), chance.randrange(len(grid[0]))]
        yield {"grid": grid, "cell": cell, "size": chance.randint(0, 2)}


def connected(grid, start, target, size):
    if not fits(grid, start, size):
        return False
    been, ring = {tuple(start)}, [tuple(start)]
    while ring:
        row, column = ring.pop()
        for other in ((row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)):
            if other not in been and fits(grid, other, size):
                been.add(other)
                ring.append(other)
    return tuple(target) in been


def connected_cases(chance):
    yield {"grid": ROOMS, "start": [3, 4], "target": [8, 15], "size": 0}
    yield {"grid": ["#####", "#.#.#", "##..#", "#####"], "start": [1, 1], "target": [2, 2], "size": 0}
    yield {"grid": ["...", "...", "..."], "start": [0, 0], "target": [2, 2], "size": 1}
    for _ in range(20):
        grid = with_door(chance)
        yield {"grid": grid, "start": [3, 4], "target": [8, 15], "size": chance.randint(0, 3)}


def widest(grid, start, target):
    size = -1
    while connected(grid, start, target, size + 1):
        size += 1
    return size


def widest_cases(chance):
    yield {"grid": ROOMS, "start": [3, 4], "target": [8, 15]}
    for _ in range(15):
        yield {"grid": with_door(chance), "start": [5, 5], "target": [6, 15]}


def with_door(chance):
    """The two rooms, with a door of up to nine cells, or none."""
    wide, top = chance.choice([0, 1, 2, 3, 4, 5, 7, 9]), chance.randint(1, 3)
    return [
        row[:10] + "." + row[11:] if top <= number < top + wide else row for number, row in enumerate(ROOMS)
    ]


def scattered(chance):
    return ["".join("#" if chance.random() < 0.12 else "." for _ in range(9)) for _ in range(7)]

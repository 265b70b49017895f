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
    for number in range(60):
        size = chance.randint(0, 2)
        grid = scattered(chance, (0.4, 0.1, 0.03)[size])
        cells = [[row, column] for row in range(len(grid)) for column in range(len(grid[0]))]
        yield {
            "grid": grid,
            "cell": chance.choice(
                [each for each in cells if fits(grid, each, size) == (number % 2 > 0)] or cells
            ),
            "size": size,
        }


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
    yield {"grid": with_door(range(1, 10)), "start": [3, 4], "target": [8, 15], "size": 3}
    for number in range(20):
        yield {
            "grid": with_door(any_door(chance), any_niches(chance)),
            "start": [3, 4],
            "target": [8, 15],
            "size": chance.randint(0, 2),
        }
        yield {**maze(chance, 1 + 2 * (number % 2), is_open=number % 4 > 1), "size": number % 2}


def widest(grid, start, target):
    size = -1
    while connected(grid, start, target, size + 1):
        size += 1
    return size


def widest_cases(chance):
    yield {"grid": ROOMS, "start": [3, 4], "target": [8, 15]}
    for number in range(8):
        yield {
            "grid": with_door(any_door(chance), any_niches(chance)),
            "start": [5, 5],
            "target": [6, 15],
        }
        yield maze(chance, chance.choice((1, 3, 5)), is_open=number % 2 > 0)


def any_door(chance):
    """The rows of a door of up to nine cells, or of none."""
    wide, top = chance.choice([0, 1, 2, 3, 4, 5, 7, 9]), chance.randint(1, 3)
    return range(top, top + wide)


def any_niches(chance):
    """Rows of the outer wall with a cell of floor that leads nowhere: how many walls there are tells nothing."""
    return chance.sample(range(1, 12), chance.randint(0, 9))


def with_door(rows, niches=()):
    """The two rooms, with a door in these rows, and niches in those."""
    cells = [list(row) for row in ROOMS]
    for row, column in [*((row, 10) for row in rows), *((row, 0) for row in niches)]:
        cells[row][column] = "."
    return ["".join(row) for row in cells]


def maze(chance, wide, is_open):
    """A maze of four by four places with corridors of this width, and a start and a target in it. A wall stands across one of
    its passages: unless the maze is open, one of the way between them."""
    start = chance.randrange(4), chance.randrange(4)
    came_from, ring = {start: start}, [start]
    while ring:
        row, column = ring[-1]
        near = [(row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)]
        new = [each for each in near if each not in came_from and 0 <= each[0] < 4 and 0 <= each[1] < 4]
        if new:
            ring.append(chance.choice(new))
            came_from[ring[-1]] = (row, column)
        else:
            ring.pop()
    target = chance.choice([each for each in came_from if each not in (start, came_from[start])])
    passages = {(place, before) for place, before in came_from.items() if place != start}
    way, place = set(), target
    while place != start:
        way.add((place, came_from[place]))
        place = came_from[place]
    if cut := sorted(passages - way if is_open else way):
        passages.remove(chance.choice(cut))
    pitch = wide + 1
    cells = [["#"] * (4 * pitch + 1) for _ in range(4 * pitch + 1)]
    for place, before in [*passages, *((place, place) for place in came_from)]:
        for row in range(min(place[0], before[0]) * pitch + 1, max(place[0], before[0]) * pitch + pitch):
            for column in range(
                min(place[1], before[1]) * pitch + 1, max(place[1], before[1]) * pitch + pitch
            ):
                cells[row][column] = "."
    middle = (1 + wide) // 2
    ends = {
        name: [each * pitch + middle for each in place]
        for name, place in (("start", start), ("target", target))
    }
    return {"grid": ["".join(row) for row in cells], **ends}


def scattered(chance, share):
    return ["".join("#" if chance.random() < share else "." for _ in range(9)) for _ in range(7)]

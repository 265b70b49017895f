"""What the three functions should return, and the cases they are tried on."""

SHARE = 0.7


def resolution(width, pixels):
    return width / pixels


def resolution_cases(chance):
    yield {"width": 5.0, "pixels": 1000}
    for _ in range(6):
        yield {"width": round(chance.uniform(1, 20), 2), "pixels": chance.randint(200, 2000)}


def dark(row, reach):
    return [
        value < SHARE * max(row[max(0, place - reach) : place + reach + 1]) for place, value in enumerate(row)
    ]


def dark_cases(chance):
    yield {"row": [220, 220, 100, 220, 220], "reach": 2}
    yield {"row": [220, 220, 110, 110, 55, 110, 110], "reach": 1}
    yield {"row": [60, 220, 220], "reach": 1}
    yield {"row": [220, 220, 60], "reach": 1}
    for _ in range(30):
        light, row = 230.0, []
        shadow = chance.randrange(5, 20)
        for place in range(25):
            light = 230.0 if place < shadow else max(100.0, light - 45.0)
            row.append(round(light * (chance.uniform(0.3, 0.6) if chance.random() < 0.2 else 1.0)))
        yield {"row": row, "reach": chance.randint(1, 4)}


def joined(marks, gap):
    closed, last = list(marks), None
    for place, mark in enumerate(marks):
        if mark:
            if last is not None and place - last - 1 <= gap:
                closed[last:place] = [True] * (place - last)
            last = place
    return closed


def joined_cases(chance):
    yield {"marks": marks_of("##.##...##"), "gap": 2}
    yield {"marks": marks_of("..#..#.."), "gap": 2}
    yield {"marks": marks_of("....."), "gap": 9}
    yield {"marks": marks_of("#.#"), "gap": 0}
    for _ in range(30):
        yield {"marks": [chance.random() < 0.4 for _ in range(20)], "gap": chance.randint(0, 4)}


def marks_of(drawing):
    return [each == "#" for each in drawing]

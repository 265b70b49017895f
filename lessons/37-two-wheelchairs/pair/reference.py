"""What the two functions should return, and the cases they are tried on."""


def split(number, count):
    return [number // count, number % count]


def split_cases(chance):
    for number in range(16):
        yield {"number": number, "count": 4}
    for _ in range(20):
        count = chance.randint(5, 30)
        yield {"number": chance.randrange(count * count), "count": count}


def paid(before, after, beside, bumped):
    progress = sum(a - b for a, b in zip(before, after, strict=True)) / 2
    return progress + 0.1 * beside - 1.0 * any(bumped)


def paid_cases(chance):
    yield {"before": [2.0, 2.0], "after": [1.8, 2.0], "beside": False, "bumped": [False, False]}
    yield {"before": [2.0, 2.0], "after": [1.9, 1.9], "beside": True, "bumped": [False, False]}
    yield {"before": [2.0, 2.0], "after": [2.0, 2.0], "beside": True, "bumped": [True, True]}
    for _ in range(30):
        before = [chance.uniform(0.5, 4) for _ in range(2)]
        yield {
            "before": before,
            "after": [each - chance.uniform(-0.1, 0.2) for each in before],
            "beside": chance.random() < 0.5,
            "bumped": [chance.random() < 0.3, chance.random() < 0.3],
        }

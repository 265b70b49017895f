"""What the function should return, and the cases it is tried on."""


def heard(offered, asked, before, after):
    if asked["reliability"] == "RELIABLE" and offered["reliability"] != "RELIABLE":
        return 0
    if asked["durability"] == "TRANSIENT_LOCAL":
        if offered["durability"] != "TRANSIENT_LOCAL":
            return 0
        return min(before, offered["depth"], asked["depth"]) + after
    return after


def heard_cases(chance):
    for offered in profiles(10):
        for asked in profiles(10):
            yield {"offered": offered, "asked": asked, "before": 3, "after": 4}
    for _ in range(80):
        yield {
            "offered": chance.choice(profiles(chance.randint(1, 6))),
            "asked": chance.choice(profiles(chance.randint(1, 6))),
            "before": chance.randint(0, 9),
            "after": chance.randint(0, 99),
        }


def profiles(depth):
    """All kinds of profile with this depth."""
    return [
        {"reliability": reliability, "durability": durability, "depth": depth}
        for reliability in ("RELIABLE", "BEST_EFFORT")
        for durability in ("VOLATILE", "TRANSIENT_LOCAL")
    ]

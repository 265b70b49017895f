"""What the three functions should return, and the cases they are tried on."""

import math

BEYOND = 0.02
FAR = 3.5


def own_rays(scans, far):
    columns = [[scan[ray] for scan in scans] for ray in range(len(scans[0]))]
    return [max(each) if max(each) < far else None for each in columns]


def own_rays_cases(chance):
    yield {"scans": [[FAR, 0.06, 1.2], [FAR, 0.07, FAR]], "far": FAR}
    yield {"scans": [[0.06, 2.0], [0.05, 0.05]], "far": 2.0}
    for _ in range(20):
        yield {"scans": turning_scans(chance), "far": FAR}


def cleaned(ranges, own, far):
    return [
        far if limit is not None and value <= limit + BEYOND else value
        for value, limit in zip(ranges, own, strict=True)
    ]


def cleaned_cases(chance):
    yield {"ranges": [0.06, 0.5, 0.06], "own": [0.07, None, None], "far": 4.0}
    yield {"ranges": [0.06, 0.5, 0.12], "own": [None, 0.07, 0.1], "far": 4.0}
    for _ in range(20):
        own = own_rays(turning_scans(chance), FAR)
        ranges = [
            round(chance.choice([chance.uniform(0.03, 0.1), chance.uniform(0.1, 3)]), 3) for _ in range(9)
        ]
        yield {"ranges": ranges, "own": own, "far": FAR}


def may_drive(ranges, age, stop, oldest):
    return age <= oldest and not any(value < stop for value in ranges)


def may_drive_cases(chance):
    yield {"ranges": [1.0, 0.2, 1.0], "age": 0.05, "stop": 0.3, "oldest": 0.2}
    yield {"ranges": [1.0, 2.0], "age": 0.5, "stop": 0.3, "oldest": 0.2}
    yield {"ranges": [math.nan, 1.0, 0.1], "age": 0.05, "stop": 0.3, "oldest": 0.2}
    yield {"ranges": [1.0, 0.1, math.nan], "age": 0.05, "stop": 0.3, "oldest": 0.2}
    yield {"ranges": [math.nan, math.nan], "age": 0.05, "stop": 0.3, "oldest": 0.2}
    yield {"ranges": [math.inf, math.inf], "age": 0.05, "stop": 0.3, "oldest": 0.2}
    for _ in range(25):
        ranges = [round(chance.uniform(0.25, 3), 2) if chance.random() < 0.9 else math.nan for _ in range(7)]
        yield {"ranges": ranges, "age": round(chance.uniform(0, 0.3), 2), "stop": 0.4, "oldest": 0.2}


def turning_scans(chance):
    """Scans of nine rays; one or two always see the robot, the others a wall now and then."""
    own = chance.sample(range(9), chance.randint(1, 2))
    distances = {ray: chance.uniform(0.04, 0.09) for ray in own}
    scans = []
    for _ in range(5):
        scan = [round(chance.uniform(0.5, 2), 3) if chance.random() < 0.3 else FAR for _ in range(9)]
        for ray, distance in distances.items():
            scan[ray] = round(distance + chance.uniform(-0.004, 0.004), 3)
        scans.append(scan)
    return scans

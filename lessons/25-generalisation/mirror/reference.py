"""What the three functions should return, and the cases they are tried on."""


def mirrored_scan(distances):
    return distances[::-1]


def mirrored_scan_cases(chance):
    for _ in range(10):
        yield {"distances": scan(chance)}


def mirrored_action(action):
    return (0, 2, 1)[action]


def mirrored_action_cases(chance):
    for action in range(3):
        yield {"action": action}


def doubled(steps):
    return steps + [
        [mirrored_scan(seen), mirrored_action(action), reward, mirrored_scan(after)]
        for seen, action, reward, after in steps
    ]


def doubled_cases(chance):
    for count in (1, 1, 2, 3, 4, 5):
        steps = [
            [scan(chance), chance.randrange(3), round(chance.uniform(-1, 1), 2), scan(chance)]
            for _ in range(count)
        ]
        yield {"steps": steps}


def scan(chance):
    return [round(chance.uniform(0.1, 2.0), 2) for _ in range(9)]

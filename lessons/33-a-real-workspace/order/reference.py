"""What the three functions should return, and the cases they are tried on."""

NAMES = ["arm", "base", "camera", "driver", "gripper", "maps", "tools", "wheels"]
OUTSIDE = ["rclpy", "sensor_msgs", "tf2_ros"]


def build_order(needs):
    done = []
    while len(done) < len(needs):
        ready = [
            each
            for each in needs
            if each not in done and all(one in done or one not in needs for one in needs[each])
        ]
        done.append(min(ready))
    return done


def build_order_cases(chance):
    yield {
        "needs": {"arm_bringup": ["arm_driver"], "arm_driver": ["arm_tools", "rclpy"], "arm_tools": ["rclpy"]}
    }
    yield {"needs": {"b": [], "a": ["c"], "c": []}}
    yield {"needs": {}}
    for _ in range(20):
        yield {"needs": workspace(chance)}


def up_to(needs, name):
    chosen, waiting = {name}, [name]
    while waiting:
        new = [one for one in needs[waiting.pop()] if one in needs and one not in chosen]
        chosen.update(new)
        waiting += new
    return [each for each in build_order(needs) if each in chosen]


def up_to_cases(chance):
    needs = {"a": [], "b": ["a"], "c": ["b", "rclpy"], "d": []}
    for name in needs:
        yield {"needs": needs, "name": name}
    for _ in range(20):
        needs = workspace(chance)
        yield {"needs": needs, "name": chance.choice(sorted(needs))}


def found(sourced, name):
    for each in reversed(sourced):
        if name in each:
            return each[name]
    return None


def found_cases(chance):
    yield {"sourced": [{"camera": "/opt/ros/camera"}, {"camera": "/home/me/camera"}], "name": "camera"}
    yield {"sourced": [{"camera": "/opt/ros/camera"}, {"arm": "/home/me/arm"}], "name": "camera"}
    yield {"sourced": [{"camera": "/opt/ros/camera"}], "name": "arm"}
    yield {"sourced": [], "name": "arm"}
    for _ in range(15):
        workspaces = [
            {each: f"/workspace_{number}/{each}" for each in chance.sample(NAMES, chance.randint(1, 5))}
            for number in range(chance.randint(1, 4))
        ]
        names = sorted({name for each in workspaces for name in each})
        yield {"sourced": workspaces, "name": chance.choice(names if chance.random() < 0.8 else NAMES)}


def workspace(chance):
    """Packages that need some of those drawn before them, and some from outside."""
    names = chance.sample(NAMES, chance.randint(2, len(NAMES)))
    needs = {
        each: chance.sample(names[:place], min(place, chance.randint(0, 2)))
        + chance.sample(OUTSIDE, chance.randint(0, 2))
        for place, each in enumerate(names)
    }
    return {each: needs[each] for each in chance.sample(names, len(names))}

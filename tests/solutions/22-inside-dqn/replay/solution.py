"""What surrounds the network of a DQN."""


def store(buffer, step, capacity):
    """The buffer after one more step."""
    return (buffer + [step])[-capacity:]


def targets(batch, next_values, gamma):
    """The targets of a batch, one for each step."""
    found = []
    for (reward, terminated), values in zip(batch, next_values):
        found.append(reward if terminated else reward + gamma * max(values))
    return found


def synced(target, online, updates, interval):
    """The target network's weights after this many updates."""
    return online if updates % interval == 0 else target

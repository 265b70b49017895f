"""A network with one layer, and one step of gradient descent."""

# Lesson: worked out once, with the weights as they were


def value(inputs, weights):
    """The sum of inputs times weights."""
    return sum(x * w for x, w in zip(inputs, weights))


def descend(inputs, weights, target, rate):
    """The weights after one step of gradient descent."""
    weights = list(weights)
    for place, x in enumerate(inputs):
        error = value(inputs, weights) - target
        weights[place] -= rate * 2 * error * x
    return weights

"""A network with one layer, and one step of gradient descent."""

# Lesson: the slope says which way is up, and the weight goes a little the other way


def value(inputs, weights):
    """The sum of inputs times weights."""
    return sum(x * w for x, w in zip(inputs, weights))


def descend(inputs, weights, target, rate):
    """The weights after one step of gradient descent."""
    error = value(inputs, weights) - target
    return [w + rate * 2 * error * x for x, w in zip(inputs, weights)]

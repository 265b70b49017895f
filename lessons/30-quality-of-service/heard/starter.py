"""How many messages reach a subscription that comes late."""


def heard(offered, asked, before, after):
    """Two profiles, and the numbers of messages before and after the
    subscription -> the number that it hears.

    A profile is a dictionary: "reliability" is "RELIABLE" or
    "BEST_EFFORT", "durability" is "VOLATILE" or "TRANSIENT_LOCAL",
    "depth" is how many messages that side keeps.
    """
    return 0  # write this

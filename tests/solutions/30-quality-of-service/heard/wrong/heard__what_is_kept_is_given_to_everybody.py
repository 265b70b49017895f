"""How many messages reach a subscription that comes late."""

# Lesson: If both say TRANSIENT_LOCAL, kept ones arrive too


def heard(offered, asked, before, after):
    if asked["reliability"] == "RELIABLE" and offered["reliability"] == "BEST_EFFORT":
        return 0
    if asked["durability"] == "TRANSIENT_LOCAL" and offered["durability"] == "VOLATILE":
        return 0
    old = min(before, offered["depth"], asked["depth"]) if offered["durability"] == "TRANSIENT_LOCAL" else 0
    return old + after

"""How many messages reach a subscription that comes late."""

# Lesson: The depths are not compared


def heard(offered, asked, before, after):
    if asked["reliability"] == "RELIABLE" and offered["reliability"] == "BEST_EFFORT":
        return 0
    if asked["durability"] == "TRANSIENT_LOCAL" and offered["durability"] == "VOLATILE":
        return 0
    if asked["depth"] > offered["depth"]:
        return 0
    old = min(before, offered["depth"], asked["depth"]) if asked["durability"] == "TRANSIENT_LOCAL" else 0
    return old + after

"""How many messages reach a subscription that comes late."""


def heard(offered, asked, before, after):
    if asked["reliability"] == "RELIABLE" and offered["reliability"] == "BEST_EFFORT":
        return 0
    wants_old = asked["durability"] == "TRANSIENT_LOCAL"
    if wants_old and offered["durability"] == "VOLATILE":
        return 0
    old = min(before, offered["depth"], asked["depth"]) if wants_old else 0
    return old + after

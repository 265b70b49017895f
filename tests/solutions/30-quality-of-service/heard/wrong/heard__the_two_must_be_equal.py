"""How many messages reach a subscription that comes late."""

# Lesson: To offer more than is asked does no harm.


def heard(offered, asked, before, after):
    if offered["reliability"] != asked["reliability"] or offered["durability"] != asked["durability"]:
        return 0
    if asked["durability"] == "TRANSIENT_LOCAL":
        return min(before, offered["depth"], asked["depth"]) + after
    return after

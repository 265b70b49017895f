"""Guards a program against what a real laser shows. A ray that meets
nothing reads `far`."""


def own_rays(scans, far):
    """The largest distance of each ray that met something in every scan,
    None for the others."""
    return None  # write this


def cleaned(ranges, own, far):
    """The scan with `far` wherever `own` has a distance and the reading
    is not more than 0.02 m beyond it."""
    return None  # write this


def may_drive(ranges, age, stop, oldest):
    """False if the scan is older than `oldest`, or a ray is nearer than
    `stop`; nan is no distance."""
    return None  # write this

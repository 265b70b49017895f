"""Guards a program against what a real laser shows. A ray that meets nothing reads `far`."""

# Lesson: each ray that always met something


def own_rays(scans, far):
    """The largest distance of each ray that met something in every scan, None for the others."""
    own = []
    for ray in range(len(scans[0])):
        values = [scan[ray] for scan in scans]
        own.append(max(values) if min(values) < far else None)
    return own


def cleaned(ranges, own, far):
    """The scan with `far` wherever `own` has a distance and the reading is not more than 0.02 m beyond it."""
    clean = []
    for ray, value in enumerate(ranges):
        is_own = own[ray] is not None and value <= own[ray] + 0.02
        clean.append(far if is_own else value)
    return clean


def may_drive(ranges, age, stop, oldest):
    """False if the scan is older than `oldest`, or a ray is nearer than `stop`; nan is no distance."""
    if age > oldest:
        return False
    return not any(value < stop for value in ranges)

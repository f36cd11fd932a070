"""What a layout file describes, as the survey sees it: stations, and drives. A drive is one way to go from a station to
another: in one direction, with one end of the AGV first. A two-way segment has two drives, a segment that is driven
with either end first twice as many."""
from math import atan2, degrees, dist, radians, tan

FORWARD, BACKWARD = "forward", "backward"
ANY, EMPTY, LOADED = "any", "empty", "loaded"
EVERYONE = (("", ANY),)


class Station:
    def __init__(self, name, x, y, purposes=(), heading=None, turning=True):
        self.name, self.x, self.y, self.turning = name, x, y, turning
        self.purposes = set(purposes)
        self.heading = heading  # degrees; none: any

    def rules(self):
        """To a tenth of a degree: files round a quarter turn to 1.57."""
        heading = None if self.heading is None else round(self.heading % 360.0, 1) % 360.0
        return sorted(self.purposes - {"routing"}), heading, self.turning


class Drive:
    """`limit`: m/s; none: no limit. `permissions`: pairs of type and load. `length`: m; none: the survey cannot tell."""

    def __init__(self, start, end, length, first=FORWARD, limit=None, permissions=EVERYONE, blocks=(), course=None):
        self.start, self.end, self.length, self.first = start, end, length, first
        self.course = course  # degrees, of the way at its end; none: the survey cannot tell
        self.limit, self.permissions, self.blocks = limit, tuple(sorted(permissions)), frozenset(blocks)

    def rules(self):
        limit = None if self.limit is None else round(self.limit, 6)
        return self.start, self.end, self.first, limit, self.permissions, tuple(sorted(self.blocks))


class Plant:
    def __init__(self):
        self.stations, self.drives = {}, []
        self.drawn = {}     # other positions that the file gives for its stations, by name
        self.faults = []    # names of what no AGV can drive or what stands there twice; a refusal names one

    def add(self, station):
        self.stations[station.name] = station

    def settle_headings(self):
        """An AGV stands as it arrives: with the heading of the drive that arrives nearest to the one that the file asks
        for. If none arrives within a degree, that heading cannot be had."""
        arrivals = {}
        for drive in self.drives:
            nose = (drive.course or 0.0) + (180.0 if drive.first == BACKWARD else 0.0)
            arrivals.setdefault(drive.end, []).append(nose)
        for station in self.stations.values():
            if station.heading is not None:
                off, nose = min((abs((nose - station.heading + 180.0) % 360.0 - 180.0), nose)
                                for nose in arrivals.get(station.name, [station.heading + 180.0]))
                station.heading = nose if off < 1.0 else None

    def types(self):
        return sorted({name for drive in self.drives for name, _ in drive.permissions} - {""})

    def core_share(self):
        """The share of stations in the largest set in which all reach each other, whoever drives."""
        ways, back = {}, {}
        for drive in self.drives:
            ways.setdefault(drive.start, set()).add(drive.end)
            back.setdefault(drive.end, set()).add(drive.start)
        left, largest = set(self.stations), 0
        while left:
            start = next(iter(left))
            core = reached(start, ways) & reached(start, back)
            largest, left = max(largest, len(core)), left - core
        return largest / len(self.stations) if self.stations else 0.0


def reached(start, ways):
    seen, todo = {start}, [start]
    while todo:
        for other in ways.get(todo.pop(), ()):
            if other not in seen:
                seen.add(other)
                todo.append(other)
    return seen


def course(points):
    """The direction in which a way of these points, or control points, ends."""
    for one in points[-2::-1]:
        if dist(one, points[-1]) > 1e-9:
            return angle_of(points[-1][0] - one[0], points[-1][1] - one[1])
    return None


def path_length(points):
    return sum(dist(a, b) for a, b in zip(points, points[1:]))


def rounded_length(points, cut=0.5):
    """Of straight legs: a circle leads round each corner, from `cut` before it, or from the middle of the leg."""
    legs = [(a, b) for a, b in zip(points, points[1:]) if dist(a, b) > 1e-6]
    total = sum(dist(a, b) for a, b in legs)
    for (a, b), (_, c) in zip(legs, legs[1:]):
        turn = abs((angle_of(c[0] - b[0], c[1] - b[1]) - angle_of(b[0] - a[0], b[1] - a[1]) + 180.0) % 360.0 - 180.0)
        if 0.001 < turn < 168.0:
            reach = min(cut, dist(a, b) / 2.0, dist(b, c) / 2.0)
            total -= 2.0 * reach - radians(turn) * reach / tan(radians(turn / 2.0))
    return total


def bezier_length(points, steps=400):
    """Of cubic curves that share their ends: 4, 7, 10, ... points. Two points: the straight line."""
    if len(points) == 2:
        return dist(*points)
    total = 0.0
    for i in range(0, len(points) - 1, 3):
        p, q, r, s = points[i:i + 4]
        curve = []
        for k in range(steps + 1):
            t = k / steps
            u = 1.0 - t
            a, b, c, d = u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t
            curve.append((a * p[0] + b * q[0] + c * r[0] + d * s[0], a * p[1] + b * q[1] + c * r[1] + d * s[1]))
        total += path_length(curve)
    return total


def angle_of(x, y):
    return degrees(atan2(y, x))

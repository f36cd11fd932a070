"""The smallest clearance between bodies, from their pieces alone."""
import math

COARSE_NS, FINE_NS = 40_000_000, 2_000_000
SAME_M = 1e-9  # what a search for less is not worth
FAR_M = 0.5  # the program reports no larger clearance


def to_side(p, a, b):
    sx, sy = b[0] - a[0], b[1] - a[1]
    k = ((p[0] - a[0]) * sx + (p[1] - a[1]) * sy) / (sx * sx + sy * sy)
    k = min(1.0, max(0.0, k))
    return math.hypot(p[0] - a[0] - k * sx, p[1] - a[1] - k * sy)


def parts(one, other):
    """Whether a side of `one` parts the two; corners go anticlockwise."""
    for i in range(4):
        (ax, ay), (bx, by) = one[i], one[(i + 1) % 4]
        if all((bx - ax) * (py - ay) - (by - ay) * (px - ax) < 0.0 for px, py in other):
            return True
    return False


def distance(one, other):
    """Of two rectangles; 0 if they overlap."""
    if not parts(one, other) and not parts(other, one):
        return 0.0
    return min(min(to_side(one[i], other[k], other[(k + 1) % 4]), to_side(other[i], one[k], one[(k + 1) % 4]))
               for i in range(4) for k in range(4))


class Pair:
    def __init__(self, one, other):
        self.one, self.other = one, other

    def gap(self, ns):
        a, b = self.one.piece(ns), self.other.piece(ns)
        return math.inf if a is None or b is None else distance(a.corners(ns), b.corners(ns))

    def fastest(self, begin_ns, end_ns):
        def of(body):
            return max((p.fastest() for p in body.pieces if p.begin_ns <= end_ns and p.end_ns >= begin_ns), default=0.0)
        return of(self.one) + of(self.other)

    def changes(self, begin_ns, end_ns):
        """Whether a piece begins in this time: a load changes the hull of a body that rests."""
        return any(begin_ns <= p.begin_ns <= end_ns for body in (self.one, self.other) for p in body.pieces)

    def curved(self, ns):
        return any(p is not None and p.curved for p in (self.one.piece(ns), self.other.piece(ns)))

    def least(self, begin_ns, end_ns):
        """The gap is nowhere less in this time, but for what curvature changes in it."""
        reach = self.fastest(begin_ns, end_ns) * (end_ns - begin_ns) * 1e-9 / 2
        return (self.gap(begin_ns) + self.gap(end_ns)) / 2 - reach

    def lowest(self, begin_ns, end_ns):
        """By thirds: the gap falls and then rises in so short a time."""
        for _ in range(70):
            if end_ns - begin_ns < 0.01:
                break
            p, q = begin_ns + (end_ns - begin_ns) / 3, end_ns - (end_ns - begin_ns) / 3
            begin_ns, end_ns = (begin_ns, q) if self.gap(p) <= self.gap(q) else (p, end_ns)
        return (begin_ns + end_ns) / 2

    def smallest(self, end_ns, below):
        """(gap, instant) if it is below `below`, else None."""
        best = None
        for begin in range(0, end_ns, COARSE_NS):
            end = min(end_ns, begin + COARSE_NS)
            if best and self.fastest(begin, end) == 0.0 and not self.changes(begin, end):
                continue  # both have rested since the last look
            if self.least(begin, end) >= below:
                continue
            seams = {p.begin_ns for body in (self.one, self.other) for p in body.pieces if begin < p.begin_ns < end}
            times = sorted(set(range(begin, end, FINE_NS)) | {end} | seams)
            gaps = [self.gap(t) for t in times]
            for i, gap in enumerate(gaps):
                low = (i == 0 or gap <= gaps[i - 1]) and (i + 1 == len(gaps) or gap <= gaps[i + 1])
                if not low:
                    continue
                if gap < below:
                    best, below = (gap, times[i]), gap
                one, other = times[max(0, i - 1)], times[min(len(times) - 1, i + 1)]
                if self.least(one, other) >= below - SAME_M:
                    continue
                at = self.lowest(one, other)
                if self.gap(at) < below:
                    best, below = (self.gap(at), at), self.gap(at)
        return best


def smallest_clearance(bodies):
    """(gap, instant, whether a bend is involved); None if all stay farther apart than FAR_M."""
    best, end_ns = None, max(body.pieces[-1].end_ns for body in bodies)
    for i, one in enumerate(bodies):
        for other in bodies[i + 1:]:
            pair = Pair(one, other)
            found = pair.smallest(end_ns, best[0] if best else FAR_M)
            if found:
                best = (*found, pair.curved(found[1]))
    return best

"""Where a body is at any instant, from the pieces that --pieces writes. Standard library only, no code of the product.

A pose is (x, y, heading x, heading y) of the reference point."""
import math

# Gauss-Legendre, ten points: exact for polynomials of degree 19.
NODES = ((0.1488743389816312, 0.2955242247147529), (0.4333953941292472, 0.2692667193099963),
         (0.6794095682990244, 0.2190863625159820), (0.8650633666889845, 0.1494513491505806),
         (0.9739065285171717, 0.0666713443086881))
PARTS = 64


class Bezier:
    """A cubic Bezier curve by the length of its arc."""

    def __init__(self, points):
        self.points = points
        self.ends = [0.0]
        for i in range(PARTS):
            self.ends.append(self.ends[-1] + self.length(i / PARTS, (i + 1) / PARTS))

    def velocity(self, u):
        (ax, ay), (bx, by), (cx, cy), (dx, dy) = self.points
        p, q, r = 3 * (1 - u) ** 2, 6 * (1 - u) * u, 3 * u * u
        return (p * (bx - ax) + q * (cx - bx) + r * (dx - cx), p * (by - ay) + q * (cy - by) + r * (dy - cy))

    def speed(self, u):
        return math.hypot(*self.velocity(u))

    def length(self, begin, end):
        middle, half = (begin + end) / 2, (end - begin) / 2
        return half * sum(w * (self.speed(middle - half * x) + self.speed(middle + half * x)) for x, w in NODES)

    def pose(self, way):
        low, high = 0, PARTS
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if self.ends[middle] <= way else (low, middle)
        begin = low / PARTS
        u = begin + (way - self.ends[low]) / max(self.ends[low + 1] - self.ends[low], 1e-300) / PARTS
        for _ in range(8):  # Newton
            step = (way - self.ends[low] - self.length(begin, u)) / self.speed(u)
            u += step
            if abs(step) < 1e-15:
                break
        (ax, ay), (bx, by), (cx, cy), (dx, dy) = self.points
        a, b, c, d = (1 - u) ** 3, 3 * (1 - u) ** 2 * u, 3 * (1 - u) * u * u, u ** 3
        vx, vy = self.velocity(u)
        size = math.hypot(vx, vy)
        return (a * ax + b * bx + c * cx + d * dx, a * ay + b * by + c * cy + d * dy, vx / size, vy / size)


class Line:
    def __init__(self, begin, end):
        size = math.hypot(end[0] - begin[0], end[1] - begin[1])
        self.begin, self.ends = begin, [0.0, size]
        self.ahead = ((end[0] - begin[0]) / size, (end[1] - begin[1]) / size)

    def pose(self, way):
        return (self.begin[0] + way * self.ahead[0], self.begin[1] + way * self.ahead[1], *self.ahead)


def track_of(points):
    if len(points) == 2:
        return [Line(*points)]
    return [Bezier(points[i:i + 4]) for i in range(0, len(points) - 1, 3)]


class Piece:
    tracks = {}  # a track is driven many times

    def __init__(self, given):
        self.begin_ns, self.end_ns, self.manner = given["begin_ns"], given["end_ns"], given["manner"]
        self.length, self.width, self.ahead = given["length_m"], given["width_m"], given["centre_ahead_m"]
        self.start = (*given["position_m"], *given["heading"])
        self.phases = given.get("motion", [])
        self.left = given.get("to_the_left", False)
        self.tail_first = given.get("tail_first", False)
        self.way_begin = given.get("way_begin_m", 0.0)
        points = tuple(map(tuple, given.get("track_m", ())))
        if points and points not in Piece.tracks:
            Piece.tracks[points] = track_of(points)
        self.track = Piece.tracks.get(points)
        self.curved = len(points) > 2

    def way_and_speed(self, ns):
        way = speed = 0.0
        since = (ns - self.begin_ns) * 1e-9
        for phase in self.phases:
            if since < phase["begin_s"]:
                break
            d = min(since, phase["end_s"]) - phase["begin_s"]
            way = phase["way"] + d * (phase["speed"] + d * phase["acceleration"] / 2)
            speed = phase["speed"] + d * phase["acceleration"]
        return way, speed

    def pose(self, ns):
        if self.manner == "rest":
            return self.start
        way, _ = self.way_and_speed(ns)
        x, y, hx, hy = self.start
        if self.manner == "turn":
            c, s = math.cos(way), math.sin(way if self.left else -way)
            return (x, y, c * hx - s * hy, s * hx + c * hy)
        way += self.way_begin
        for part in self.track[:-1]:
            if way <= part.ends[-1]:
                break
            way -= part.ends[-1]
        else:
            part = self.track[-1]
        x, y, hx, hy = part.pose(way)
        return (x, y, -hx, -hy) if self.tail_first else (x, y, hx, hy)

    def speed(self, ns):
        return self.way_and_speed(ns)[1] if self.manner == "drive" else 0.0

    def corners(self, ns):
        x, y, hx, hy = self.pose(ns)
        x, y, a, b = x + self.ahead * hx, y + self.ahead * hy, self.length / 2, self.width / 2
        return [(x + i * a * hx - k * b * hy, y + i * a * hy + k * b * hx)
                for i, k in ((1, 1), (-1, 1), (-1, -1), (1, -1))]

    def fastest(self):
        """No point of the body is faster, on a line or in a turn; in a bend hardly."""
        top = max([p["speed"] for p in self.phases] +
                  [p["speed"] + (p["end_s"] - p["begin_s"]) * p["acceleration"] for p in self.phases] + [0.0])
        reach = math.hypot(self.length / 2 + abs(self.ahead), self.width / 2)
        return top * reach if self.manner == "turn" else top * (1 + reach) if self.curved else top


class Body:
    def __init__(self, given):
        self.name, self.pieces = given["body"], [Piece(piece) for piece in given["pieces"]]

    def piece(self, ns):
        """At a seam, the earlier one. None: the body is not on the floor."""
        low, high = 0, len(self.pieces)
        while low < high:
            middle = (low + high) // 2
            low, high = (middle + 1, high) if self.pieces[middle].end_ns < ns else (low, middle)
        return self.pieces[low] if low < len(self.pieces) and self.pieces[low].begin_ns <= ns else None

"""Open-RMF buildings of the traffic editor, and nav graphs, by the names that its source uses."""
import cmath
from itertools import combinations
from math import dist

from flow_yaml import load
from plant import BACKWARD, FORWARD, Drive, Plant, Station

OTHER = {FORWARD: BACKWARD, BACKWARD: FORWARD}
PURPOSES = {"is_charger": "charging", "is_parking_spot": "parking", "pickup_dispenser": "storage",
            "dropoff_ingestor": "storage"}


def words_of(item):
    """The attributes at the end of a vertex or lane; buildings write [type, value]."""
    words = item[-1] if len(item) > 2 and isinstance(item[-1], dict) else {}
    return {key: value[1] if isinstance(value, list) and len(value) == 2 else value for key, value in words.items()}


def mean(values):
    return sum(values) / len(values)


def measured(level):
    shares = [words["distance"][1] / dist(*(level["vertices"][i][:2] for i in (start, end)))
              for start, end, words in level.get("measurements") or []]
    return mean(shares) if shares else 1.0


def frame_of(root, level, is_graph):
    """The metres of a pixel, and a function from a vertex to its place as a complex number."""
    if is_graph or root.get("coordinate_system") == "cartesian_meters":
        return 1.0, lambda vertex: complex(vertex[0], vertex[1])
    levels = root["levels"]
    reference = levels[root.get("reference_level_name", next(iter(levels)))]
    pairs = [(there[:2], here[:2]) for there in reference.get("fiducials") or []
             for here in level.get("fiducials") or [] if there[2] == here[2]]
    shares = [dist(a[1], b[1]) / dist(a[0], b[0]) for a, b in combinations(pairs, 2)]
    if reference is level or not shares:
        metres = measured(level)
        return metres, lambda vertex: complex(vertex[0], -vertex[1]) * metres
    metres = measured(reference) / mean(shares)
    upright = [tuple(complex(place[0], -place[1]) for place in pair) for pair in pairs]
    bearings = [cmath.phase((a[0] - b[0]) / (a[1] - b[1])) for a, b in combinations(upright, 2)]
    turn = cmath.rect(metres, cmath.phase(sum(cmath.rect(1.0, bearing) for bearing in bearings)))
    shift = mean([there * measured(reference) - here * turn for there, here in upright])
    return metres, lambda vertex: complex(vertex[0], -vertex[1]) * turn + shift


def read(path, level=None, graph=0):
    with open(path, encoding="utf-8") as file:
        root = load(file.read())
    levels = root["levels"]
    chosen = levels[level or next((name for name in levels if levels[name].get("lanes")), next(iter(levels)))]
    vertices = chosen["vertices"]
    is_graph = isinstance(vertices[0][2] if len(vertices[0]) > 2 else {}, dict)
    metres, place_of = frame_of(root, chosen, is_graph)
    lanes = [lane for lane in chosen["lanes"] if is_graph or int(words_of(lane).get("graph_idx", 0)) == graph]
    spot_of = spots(vertices, lanes, metres)
    plant, names = Plant(), {}

    def name_of(index):
        vertex = vertices[index]
        return (words_of(vertex).get("name") if is_graph else vertex[3] if len(vertex) > 3 else "") or ""

    given = {str(name_of(index)) for index in range(len(vertices))}

    def free_name(index):
        name = f"v{index}"
        while name in plant.stations or name in given:
            name += "_"
        return name

    def station(index):
        spot = spot_of[index]
        if spot[0] not in names:
            vertex, words = vertices[spot[0]], [words_of(vertices[member]) for member in spot]
            name = next((str(name_of(member)) for member in spot if name_of(member)), free_name(spot[0]))
            names[spot[0]] = name if name not in plant.stations else free_name(spot[0])
            place = place_of(vertex)
            plant.add(Station(names[spot[0]], place.real, place.imag,
                              {purpose for key, purpose in PURPOSES.items() if any(word.get(key) for word in words)}))
        return plant.stations[names[spot[0]]]

    for lane in lanes:
        if spot_of[lane[0]] is not spot_of[lane[1]]:
            add_lane(plant, station(lane[0]), station(lane[1]), words_of(lane))
    return plant


def spots(vertices, lanes, metres):
    """Of each vertex: all vertices that lanes shorter than a millimetre join with it, in order."""
    spot_of = [[index] for index in range(len(vertices))]
    for lane in lanes:
        one, other = spot_of[lane[0]], spot_of[lane[1]]
        if one is not other and dist(vertices[lane[0]][:2], vertices[lane[1]][:2]) * metres <= 1e-3:
            joined = sorted(one + other)
            for member in joined:
                spot_of[member] = joined
    return spot_of


def add_lane(plant, start, end, words):
    length = dist((start.x, start.y), (end.x, end.y))
    first = words.get("orientation") or words.get("orientation_constraint")
    asks = first in OTHER
    first = first if asks else FORWARD
    limit = words.get("speed_limit") or None
    limit = limit if limit and limit > 0.0 else None
    blocks = [words["mutex"]] if words.get("mutex") else []
    plant.drives.append(Drive(start.name, end.name, length, first, limit, blocks=blocks))
    if words.get("bidirectional") or words.get("is_bidirectional"):
        back = OTHER[first] if asks else FORWARD
        plant.drives.append(Drive(end.name, start.name, length, back, limit, blocks=blocks))

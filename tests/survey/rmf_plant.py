"""Open-RMF buildings of the traffic editor, and nav graphs, by the names that its source uses."""
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


def scale_of(root, level, is_graph):
    if is_graph or root.get("coordinate_system") == "cartesian_meters":
        return 1.0, 1.0
    shares = []
    for start, end, words in level.get("measurements") or []:
        pixels = dist(*(level["vertices"][i][:2] for i in (start, end)))
        shares.append(words["distance"][1] / pixels)
    metres = sum(shares) / len(shares) if shares else 1.0
    return metres, -metres


def read(path, level=None, graph=0):
    with open(path, encoding="utf-8") as file:
        root = load(file.read())
    chosen = root["levels"][level or next(iter(root["levels"]))]
    vertices = chosen["vertices"]
    is_graph = isinstance(vertices[0][2] if len(vertices[0]) > 2 else {}, dict)
    scale = scale_of(root, chosen, is_graph)
    plant, names = Plant(), {}

    def station(index):
        if index not in names:
            vertex, words = vertices[index], words_of(vertices[index])
            name = words.get("name") if is_graph else vertex[3] if len(vertex) > 3 else ""
            name = str(name) if name else f"v{index}"
            names[index] = name if name not in plant.stations else f"v{index}"
            plant.add(Station(names[index], vertex[0] * scale[0], vertex[1] * scale[1],
                              {purpose for key, purpose in PURPOSES.items() if words.get(key)}))
        return plant.stations[names[index]]

    for lane in chosen["lanes"]:
        words = words_of(lane)
        if is_graph or int(words.get("graph_idx", 0)) == graph:
            add_lane(plant, station(lane[0]), station(lane[1]), words)
    return plant


def add_lane(plant, start, end, words):
    length = dist((start.x, start.y), (end.x, end.y))
    first = words.get("orientation") or words.get("orientation_constraint")
    asks = first in OTHER
    first = first if asks else FORWARD
    limit = words.get("speed_limit") or None
    limit = limit if limit and limit > 0.0 else None
    blocks = [words["mutex"]] if words.get("mutex") else []
    plant.drives.append(Drive(start.name, end.name, length, first, limit, blocks=blocks))
    if words.get("bidirectional"):
        back = OTHER[first] if asks else FORWARD
        plant.drives.append(Drive(end.name, start.name, length, back, limit, blocks=blocks))

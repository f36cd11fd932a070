"""Route graphs of Nav2 in GeoJSON, with coordinates in metres."""
import json
from math import dist

from plant import Drive, Plant, Station

ENDS = [("startid", "endid"), ("start_node", "end_node"), ("from", "to"), ("source", "target")]
CORNER = 0.5            # metres from a corner at which the arc around it begins and ends
WORDS = {"charg": "charging", "park": "parking", "pick": "storage", "drop": "storage", "storage": "storage"}


def said(feature, key):
    words = feature.get("properties") or {}
    return words.get(key, (words.get("metadata") or {}).get(key))


def purposes_of(feature):
    text = str(said(feature, "type") or "").lower()
    return {purpose for word, purpose in WORDS.items() if text.startswith(word)}


def way_of(feature):
    places = feature["geometry"]["coordinates"]
    while places and isinstance(places[0][0], list):
        places = [place for part in places for place in part]
    return [tuple(place[:2]) for place in places]


def length_of(way):
    """None where the way has corners: an arc is shorter than the corner that it leads round."""
    legs = [dist(a, b) for a, b in zip(way, way[1:])]
    return sum(legs) if abs(sum(legs) - dist(way[0], way[-1])) < 1e-6 else None


def read(path, level=None, graph=0):
    with open(path, encoding="utf-8") as file:
        features = json.load(file)["features"]
    plant, stations = Plant(), {}
    for feature in features:
        if feature["geometry"]["type"] == "Point":
            key = str(feature.get("id") if said(feature, "id") is None else said(feature, "id"))
            x, y = feature["geometry"]["coordinates"][:2]
            stations[key] = Station(str(said(feature, "name") or key), x, y, purposes_of(feature))
            plant.add(stations[key])
    for feature in features:
        if feature["geometry"]["type"] == "Point":
            continue
        start, end = next((str(said(feature, a)), str(said(feature, b))) for a, b in ENDS
                          if said(feature, a) is not None)
        if start == end:
            continue
        one, other = stations[start], stations[end]
        way = way_of(feature)
        way = [(one.x, one.y)] + way[1:-1] + [(other.x, other.y)]
        limit = said(feature, "abs_speed_limit")
        plant.drives.append(Drive(one.name, other.name, length_of(way), limit=limit))
    return plant

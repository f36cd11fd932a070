"""Maps of SEER robots: the JSON of a protocol buffer, which leaves out what is 0."""
import json
from base64 import b64decode
from math import atan2, degrees, dist

from plant import BACKWARD, FORWARD, Drive, Plant, Station

PURPOSES = {"ActionPoint": {"storage"}, "TransferLocation": {"storage"}, "ChargePoint": {"charging"},
            "ParkPoint": {"parking"}}
CHORDS = 10000


def place(pos):
    return pos.get("x", 0.0), pos.get("y", 0.0)


def properties(item):
    found = {}
    for entry in item.get("property", []):
        typed = [value for key, value in entry.items() if key.endswith("Value")]
        text = b64decode(entry["value"]).decode() if "value" in entry else "0"
        found[entry["key"]] = typed[0] if typed else text == "true" if entry.get("type") == "bool" else float(text)
    return found


def point_on(corners, share):
    """By de Casteljau."""
    while len(corners) > 1:
        corners = [tuple(a + (b - a) * share for a, b in zip(*pair)) for pair in zip(corners, corners[1:])]
    return corners[0]


def read(path, level=None, graph=0):
    with open(path, encoding="utf-8") as file:
        root = json.load(file)
    plant = Plant()
    for point in root["advancedPointList"]:
        purposes = PURPOSES.get(point.get("className"), set())
        heading = degrees(point.get("dir", 0.0)) if purposes and not point.get("ignoreDir") else None
        plant.add(Station(point["instanceName"], *place(point["pos"]), purposes, heading,
                          properties(point).get("allowrotate", True)))
    for curve in root["advancedCurveList"]:
        one, other = (plant.stations[curve[end]["instanceName"]] for end in ("startPos", "endPos"))
        times = 2 if curve["className"] == "DegenerateBezier" else 1  # a quintic, with each of its two points twice
        corners = [(one.x, one.y)] + [place(curve[key]) for key in ("controlPos1", "controlPos2") if key in curve
                                      for _ in range(times)]
        corners.append((other.x, other.y))
        spots = [point_on(corners, i / CHORDS) for i in range(CHORDS + 1)]
        words = properties(curve)
        last = corners[-2]
        plant.drives.append(Drive(one.name, other.name, sum(map(dist, spots, spots[1:])),
                                  BACKWARD if words.get("direction") == 1 else FORWARD, words.get("maxspeed") or None,
                                  course=degrees(atan2(other.y - last[1], other.x - last[0]))))
    plant.settle_headings()
    return plant

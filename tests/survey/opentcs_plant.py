"""openTCS plant models, read with Python's own XML parser and by the names in the schemas of openTCS."""
import re
import xml.etree.ElementTree as xml
from math import isnan

from plant import BACKWARD, Drive, Plant, Station, bezier_length, course, rounded_length

PURPOSES = (("charging", r"charg"), ("parking", r"park"),
            ("storage", r"load|transfer|storage|store|pick|drop|deliver|fetch|jacking|pack|work"))
BENDS = {"BEZIER": 2, "BEZIER_3": 5}
FASTEST_MM_S = 100_000  # a limit above the fastest vehicle is none


def purposes_of(words):
    text = "\n".join(words).lower()
    return {purpose for purpose, pattern in PURPOSES if re.search(pattern, text)}


def position(element, prefix=""):
    """In metres; older models write xPosition where newer ones write positionX."""
    for x, y in (("positionX", "positionY"), ("xPosition", "yPosition")):
        if element is not None and x in element.attrib:
            return float(element.get(x)) / 1000.0, float(element.get(y)) / 1000.0
    return None


class Drawing:
    """Where points are drawn, and how paths bend: in the elements themselves, or in elements of the drawing."""

    def __init__(self, model):
        visual = model.find("visualLayout")
        self.scale = [float(visual.get(k, 50.0)) if visual is not None else 50.0 for k in ("scaleX", "scaleY")]
        self.elements = {}
        for element in model.iterfind("visualLayout/modelLayoutElement"):
            words = {p.get("name"): p.get("value") for p in element.iterfind("property")}
            self.elements.setdefault(element.get("visualizedObjectName"), words)

    def point(self, point):
        words = self.elements.get(point.get("name"), {})
        if "POSITION_X" in words:
            return float(words["POSITION_X"]) / 1000.0, float(words["POSITION_Y"]) / 1000.0
        return position(point.find("pointLayout"))

    def bend(self, path):
        """The kind of a path and its points in metres; none for all that is drawn straight or is a style of drawing."""
        layout = path.find("pathLayout")
        if layout is not None:
            kind = layout.get("connectionType", "DIRECT")
            pairs = [(c.get("x"), c.get("y")) for c in layout.iterfind("controlPoint")]
        else:
            words = self.elements.get(path.get("name"), {})
            kind = words.get("CONN_TYPE", "DIRECT")
            pairs = [pair.split(",") for pair in words.get("CONTROL_POINTS", "").split(";") if pair]
        if kind.upper() not in BENDS and kind.upper() != "POLYPATH":
            return "DIRECT", []
        # The y axis of the drawing points down.
        return kind.upper(), [(float(x) * self.scale[0] / 1000.0, -float(y) * self.scale[1] / 1000.0) for x, y in pairs]


def allowed(element):
    return [operation.get("name") for operation in element.iterfind("allowedOperation")]


def purposes_by_point(model):
    types = {}
    for kind in model.iterfind("locationType"):
        old = kind.find("property[@name='tcs:defaultLocationTypeSymbol']")
        new = kind.find("locationTypeLayout")
        symbol = (new.get("locationRepresentation") if new is not None else None) or \
            (old.get("value") if old is not None else "")
        types[kind.get("name")] = (allowed(kind), [kind.get("name")], [symbol])
    found = {}
    for location in model.iterfind("location"):
        if location.get("locked") == "true":
            continue
        for link in location.iterfind("link"):
            operations, name, symbol = types[location.get("type")]
            for words in (allowed(link) or operations, name, symbol):
                if purposes_of(words):
                    found.setdefault(link.get("point"), set()).update(purposes_of(words))
                    break
    return found


def limit(velocity):
    return velocity / 1000.0 if velocity is not None and 0 < velocity <= FASTEST_MM_S else None


def add_path(plant, path, drawing, blocks, where):
    start, end = path.get("sourcePoint"), path.get("destinationPoint")
    ends = [where(plant.stations[start]), where(plant.stations[end])]
    kind, points = drawing.bend(path)
    way = [ends[0], *points, ends[1]]
    length = rounded_length(way) if kind == "POLYPATH" else bezier_length(way)
    if length < 0.01:
        plant.faults.append(path.get("name"))
    ahead, back = (float(path.get(k)) if k in path.attrib else None for k in ("maxVelocity", "maxReverseVelocity"))
    if ahead is None or ahead > 0:
        plant.drives.append(Drive(start, end, length, limit=limit(ahead), blocks=blocks, course=course(way)))
    if back is not None and back > 0:
        plant.drives.append(Drive(end, start, length, BACKWARD, limit(back), blocks=blocks, course=course(way[::-1])))


def read(path, drawn=False):
    """`drawn`: with the stations where they are drawn."""
    model = xml.parse(path).getroot()
    plant, drawing, purposes = Plant(), Drawing(model), purposes_by_point(model)
    for point in model.iterfind("point"):
        if point.get("name") in plant.stations:
            plant.faults.append(f'"{point.get("name")}"')
        x, y = position(point)
        angle = float(point.get("vehicleOrientationAngle", "NaN"))
        station = Station(point.get("name"), x, y, purposes.get(point.get("name"), ()),
                          heading=None if isnan(angle) else angle)
        if point.get("type") == "PARK_POSITION":
            station.purposes.add("parking")
        plant.add(station)
        if drawing.point(point):
            plant.drawn[station.name] = drawing.point(point)
    if drawn and plant.drawn:
        for name, station in plant.stations.items():
            station.x, station.y = plant.drawn.get(name, (station.x, station.y))
    blocks = {}
    for block in model.iterfind("block"):
        for member in block.iterfind("member"):
            blocks.setdefault(member.get("name"), set()).add(block.get("name"))
    for element in model.iterfind("path"):
        if element.get("locked") != "true":
            add_path(plant, element, drawing, blocks.get(element.get("name"), ()), lambda s: (s.x, s.y))
    plant.settle_headings()
    return plant

"""LIF 1.0 and the spellings of its successor, by the names in their specification."""
import json
from math import dist, pi

from plant import ANY, BACKWARD, EMPTY, FORWARD, LOADED, Drive, Plant, Station, course, path_length, rounded_length

ON_THE_NODE_M = 0.05
ONE_PLACE_M = 0.001


def given(entry, *keys):
    return next((entry[key] for key in keys if key in entry), None)


def rules_of(element):
    return [rule for key in ("vehicleTypeNodeProperties", "mobileRobotTypeNodeProperties",
                             "vehicleTypeEdgeProperties", "mobileRobotTypeEdgeProperties")
            for rule in element.get(key, [])]


def types_of(entry):
    """Names of types of vehicles; [""]: all of them."""
    name = given(entry, "vehicleTypeId", "mobileRobotTypeId")
    if name is not None:
        return [name]
    names = given(entry, "vehicleTypeIds", "mobileRobotTypeIds")
    if names is not None:
        return names
    if "mobileRobotTypes" not in entry:
        return [""]
    return [".".join(filter(None, (robot.get("manufacturer"), robot["seriesName"])))
            for robot in entry["mobileRobotTypes"]]


def named_types(elements):
    return {name for element in elements for entry in rules_of(element) for name in types_of(entry)} - {""}


def permitted(element, everyone):
    """Type -> set of loads."""
    entries = rules_of(element)
    if not entries:
        return {name: {EMPTY, LOADED} for name in everyone}
    found = {}
    for entry in entries:
        loads = entry.get("loadRestriction", {"unloaded": True, "loaded": True})
        states = {state for key, state in (("unloaded", EMPTY), ("loaded", LOADED)) if loads.get(key, True)}
        for name in types_of(entry):
            for each in [name] if name else everyone:
                found.setdefault(each, set()).update(states)
    return found


def permissions(edge, nodes, everyone):
    """None: no AGV may drive here."""
    by_type = permitted(edge, everyone)
    for node in nodes:
        by_type = {name: loads for name, loads in by_type.items() if name in permitted(node, everyone)}
    by_type = {name: loads for name, loads in by_type.items() if loads}
    if not by_type:
        return None
    word = {name: ANY if len(loads) == 2 else next(iter(loads)) for name, loads in by_type.items()}
    if set(by_type) == set(everyone) and len(set(word.values())) == 1:
        return (("", next(iter(word.values()))),)
    return tuple(word.items())


def purposes_of(element):
    found = set()
    for entry in rules_of(element):
        for action in entry.get("actions", []):
            found |= {"pick": {"storage"}, "drop": {"storage"}, "startCharging": {"charging"}}.get(
                action["actionType"], set())
    return found


def firsts_of(edge):
    """Which end of the AGV goes first; sideways travel is taken as forward."""
    firsts = set()
    for entry in rules_of(edge) or [{}]:
        ways = [angle for angle in orientations(entry) if along(entry, angle)]
        firsts |= {BACKWARD if round(abs(angle) / pi) % 2 else FORWARD for angle in ways or [0.0]}
    return firsts


def spline_length(trajectory, ends):
    """A NURBS by de Boor's recursion. None if its ends are not on the nodes: then it is changed."""
    degree, knots = int(trajectory.get("degree", 1)), trajectory["knotVector"]
    controls = [(p["x"], p["y"], p.get("weight", 1.0)) for p in trajectory["controlPoints"]]
    if degree == 1:
        points = [(x, y) for x, y, _ in controls]
        return rounded_length(points) if misses(points, ends) < ON_THE_NODE_M else None
    points = []
    for k in range(4001):
        t = knots[degree] + (knots[-degree - 1] - knots[degree]) * k / 4000
        span = max(i for i in range(degree, len(controls)) if knots[i] <= t or i == degree)
        d = [(x * w, y * w, w) for x, y, w in controls[span - degree:span + 1]]
        for r in range(1, degree + 1):
            for j in range(degree, r - 1, -1):
                low, high = knots[j + span - degree], knots[j + 1 + span - r]
                a = (t - low) / (high - low) if high > low else 0.0
                d[j] = tuple((1.0 - a) * u + a * v for u, v in zip(d[j - 1], d[j]))
        points.append((d[degree][0] / d[degree][2], d[degree][1] / d[degree][2]))
    return path_length(points) if misses(points, ends) < ON_THE_NODE_M else None


def misses(points, ends):
    return min(max(dist(points[0], a), dist(points[-1], b)) for a, b in (ends, ends[::-1]))


def heading_of(node):
    angles = {round(entry["theta"] * 180.0 / pi, 4) for entry in rules_of(node) if "theta" in entry}
    return angles.pop() if len(angles) == 1 else None


def heading_at(joined, nodes, driven):
    """Of nodes at one place those count at which AGVs have something to do, or all if there are none."""
    busy = [name for name in joined if purposes_of(nodes[name]) or
            any(purposes_of(edge) for edge in driven if edge["endNodeId"] == name)]
    asked = {heading_of(nodes[name]) for name in busy or joined} - {None}
    return asked.pop() if len(asked) == 1 else None


def turning_of(name, edges):
    """No AGV may turn at a node if no edge that arrives there lets it, or none that leaves."""
    for end, key in (("endNodeId", "rotationAtEndNodeAllowed"), ("startNodeId", "rotationAtStartNodeAllowed")):
        here = [edge for edge in edges if edge[end] == name]
        if here and all(forbids(edge, key) for edge in here):
            return False
    return True


def forbids(edge, key):
    """An AGV that may turn on the edge, or drives it sideways, must turn somewhere."""
    entries = rules_of(edge)
    return bool(entries) and not is_sideways(edge) and \
        all(entry.get(key) == "NONE" and not entry.get("rotationAllowed") for entry in entries)


def is_sideways(edge):
    return not all(any(along(entry, angle) for angle in orientations(entry)) for entry in rules_of(edge))


def orientations(entry):
    """One in LIF 1.0; a list of those among which one chooses in its successor. What is no list of angles says
    nothing."""
    angles = [entry["vehicleOrientation"]] if "vehicleOrientation" in entry else []
    for key in ("vehicleOrientations", "mobileRobotOrientations"):
        listed = entry.get(key)
        if isinstance(listed, list) and all(isinstance(a, (int, float)) and abs(a) <= 1e4 for a in listed):
            angles += listed
    return angles or [0.0]


def along(entry, angle):
    half_turns = abs(angle) / pi
    return entry.get("orientationType", "TANGENTIAL") == "TANGENTIAL" and abs(half_turns - round(half_turns)) < 0.005


def place_of(node):
    return node["nodePosition"]["x"], node["nodePosition"]["y"]


def stays(edge, nodes):
    """An edge of no length: an AGV turns there, from one node to another at the same place."""
    here = place_of(nodes[edge["startNodeId"]])
    places = [place_of(nodes[edge["endNodeId"]])]
    for entry in rules_of(edge):
        places += [(p["x"], p["y"]) for p in (entry.get("trajectory") or {"controlPoints": []})["controlPoints"]]
    return all(dist(here, place) <= ONE_PLACE_M for place in places)


def spots_of(nodes, turns):
    """Node -> the first of the nodes that are one station with it."""
    first = {name: name for name in nodes}
    for edge in turns:
        both = {first[edge["startNodeId"]], first[edge["endNodeId"]]}
        least = min(both, key=list(nodes).index)
        first = {name: least if its in both else its for name, its in first.items()}
    return first


def turns_on(edge):
    return any(entry.get("rotationAllowed") or not entry.get("reachOrientationBeforeEntering", True)
               for entry in rules_of(edge))


def layouts_of(root):
    return [layout for holder in root.get("origins", [root]) for layout in holder.get("layouts", [])]


def without_nulls(pairs):
    return {key: value for key, value in pairs if value is not None}


def read(path, level=None):
    with open(path, encoding="utf-8-sig") as file:
        layouts = layouts_of(json.load(file, object_pairs_hook=without_nulls))
    found = next(filter(None, ([layout for layout in layouts if level in (None, layout.get(key))]
                               for key in ("layoutId", "layoutLevelId"))), [])
    if len(found) != 1:
        raise ValueError(f"{len(found)} layouts to choose from")
    chosen = found[0]
    nodes = {node["nodeId"]: node for node in chosen["nodes"]}
    edges = [edge for edge in chosen["edges"] if edge["startNodeId"] in nodes and edge["endNodeId"] in nodes]
    everyone = named_types([*chosen["nodes"], *chosen["edges"]]) or {""}
    driven = [edge for edge in edges if who(edge, nodes, everyone) is not None]
    turns = [edge for edge in driven if stays(edge, nodes)]
    spot = spots_of(nodes, turns)
    plant = Plant()
    for name in nodes:
        if spot[name] == name:
            joined = [other for other in nodes if spot[other] == name]
            plant.add(station_of(joined, nodes, driven, [edge for edge in turns if edge["startNodeId"] in joined]))
    for edge in driven:
        plant.stations[spot[edge["endNodeId"]]].purposes |= purposes_of(edge)
    for edge in driven:
        if edge not in turns:
            add_edge(plant, edge, spot, who(edge, nodes, everyone))
    for station in chosen.get("stations", []):
        for name in station["interactionNodeIds"]:
            if name in nodes and not plant.stations[spot[name]].purposes:
                plant.stations[spot[name]].purposes.add("storage")
    plant.settle_headings()
    return plant


def station_of(joined, nodes, driven, turns):
    """Of nodes at one place: AGVs turn there if they may at one of the nodes, or on an edge between them."""
    return Station(joined[0], *place_of(nodes[joined[0]]), set().union(*(purposes_of(nodes[name]) for name in joined)),
                   heading_at(joined, nodes, driven),
                   any(turning_of(name, driven) for name in joined) or any(map(turns_on, turns)))


def who(edge, nodes, everyone):
    """None: no AGV may drive here."""
    return permissions(edge, (nodes[edge["startNodeId"]], nodes[edge["endNodeId"]]), everyone)


def add_edge(plant, edge, spot, permitted_to):
    start, end = spot[edge["startNodeId"]], spot[edge["endNodeId"]]
    ends = [(plant.stations[name].x, plant.stations[name].y) for name in (start, end)]
    drawn = next((entry["trajectory"] for entry in rules_of(edge) if "trajectory" in entry), None)
    length = spline_length(drawn, ends) if drawn else dist(*ends)
    if length is not None and length < 0.01 or start == end:
        plant.faults.append(edge["edgeId"])
    limits = [given(entry, "maxSpeed", "maximumSpeed") for entry in rules_of(edge)]
    lowest = min((value for value in limits if value is not None), default=None)
    for first in firsts_of(edge):
        plant.drives.append(Drive(start, end, length, first, lowest, permitted_to, course=course(way_of(drawn, ends))))


def way_of(trajectory, ends):
    controls = [(p["x"], p["y"]) for p in trajectory["controlPoints"]] if trajectory else []
    if controls and dist(controls[0], ends[1]) < dist(controls[0], ends[0]):
        controls.reverse()
    return [ends[0], *controls[1:-1], ends[1]]

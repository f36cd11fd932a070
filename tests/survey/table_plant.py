"""CSV tables of nodes and edges, grid maps, and fleetproof's own layout file."""
import csv
import json

from plant import BACKWARD, EVERYONE, FORWARD, Drive, Plant, Station, angle_of, bezier_length

PITCH_M = 1.2
FIRSTS = {"": [FORWARD], "forward": [FORWARD], "backward": [BACKWARD], "either": [FORWARD, BACKWARD]}


def add_segment(plant, start, end, points, ways, permissions, blocks):
    """`ways`: for each direction that is driven, from `start` on: travel and limit."""
    ends = [(plant.stations[name].x, plant.stations[name].y) for name in (start, end)]
    length = bezier_length([ends[0], *points, ends[1]])
    for (one, other), (travel, limit) in zip(((start, end), (end, start)), ways):
        for first in FIRSTS[travel]:
            plant.drives.append(Drive(one, other, length, first, limit or None, permissions or EVERYONE, blocks))


def read_layout(path):
    with open(path, encoding="utf-8") as file:
        layout = json.load(file)["layout"]
    plant = Plant()
    for s in layout["stations"]:
        heading = angle_of(*s["heading"]) if "heading" in s else None
        plant.add(Station(s["name"], *s["position_m"], s.get("purposes", ["routing"]), heading, s.get("turning", True)))
    for s in layout["segments"]:
        ways = [(s.get("travel", ""), s.get("speed_limit_mps")),
                (s.get("back_travel", ""), s.get("back_speed_limit_mps"))]
        who = [(p.get("vehicle_type", ""), p.get("load", "any")) for p in s.get("permissions", [])]
        add_segment(plant, s["from"], s["to"], s.get("control_points_m", []), ways[:2 if s.get("bidirectional") else 1],
                    who, s.get("blocks", []))
    return plant


def parts(text, mark="|"):
    """What stands between the marks; a mark after a backslash belongs to a part."""
    found, escaped = [""], False
    for letter in text:
        if letter == mark and not escaped:
            found.append("")
        elif letter == "\\" and not escaped:
            escaped = True
            continue
        else:
            found[-1] += letter
        escaped = False
    return [part for part in found if part]


def read_csv(path):
    plant, columns = Plant(), []
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.reader(line for line in file if line.strip() and not line.startswith("#")):
            if {"id", "x", "y"} <= set(row) or {"from", "to"} <= set(row):
                columns = row
                continue
            field = dict(zip(columns, row))
            if "id" in field:
                x, y = (field.get("heading") or "0 0").split()
                purposes = [] if field.get("purposes") == "none" else field.get("purposes", "").split()
                plant.add(Station(field["id"], float(field["x"]), float(field["y"]), purposes,
                                  angle_of(float(x), float(y)) if field.get("heading") else None,
                                  field.get("turning") not in ("false", "0")))
            elif "from" in field:
                add_row(plant, field)
    return plant


def add_row(plant, field):
    numbers = [float(word) for word in field.get("control_points", "").split()]
    ways = [(field.get(travel, ""), float(field.get(limit) or 0.0))
            for travel, limit in (("travel", "speed_limit_mps"), ("back_travel", "back_speed_limit_mps"))]
    both = field.get("bidirectional") in ("true", "1")
    who = [tuple(part.rsplit(":", 1)) for part in parts(field.get("permissions", ""))]
    blocks = [part.rsplit(":", 1)[0] for part in parts(field.get("blocks", ""))]
    add_segment(plant, field["from"], field["to"], list(zip(numbers[::2], numbers[1::2])), ways[:2 if both else 1],
                who, blocks)


def read_grid(path):
    """Free cells are joined with the free cells beside them."""
    with open(path, encoding="utf-8") as file:
        head, cells = file.read().split("\nmap\n", 1)
    height = next(int(line.split()[1]) for line in head.splitlines() if line.startswith("height"))
    rows = cells.splitlines()[:height]
    plant = Plant()
    has_service = any(letter in "SE" for row in rows for letter in row)
    for r, row in enumerate(rows):
        for c, letter in enumerate(row):
            if letter in ".GSE":
                purposes = {"storage"} if letter in "SE" and has_service else set()
                plant.add(Station(f"r{r}c{c}", c * PITCH_M, (len(rows) - 1 - r) * PITCH_M, purposes))
    for name in list(plant.stations):
        r, c = map(int, name[1:].split("c"))
        for other in (f"r{r + 1}c{c}", f"r{r - 1}c{c}", f"r{r}c{c + 1}", f"r{r}c{c - 1}"):
            if other in plant.stations:
                plant.drives.append(Drive(name, other, PITCH_M))
    return plant

"""judge.py PIECES POSES OUTCOME [SCENARIO]: judges a run again from the files that `simulate --pieces PIECES --poses
POSES --json > OUTCOME` wrote. Prints every difference; exit code 1 if there is one."""
import csv
import json
import math
import sys

from clearance import Pair, smallest_clearance
from motion import Body

POSE_M = 1e-9           # of a pose, and of what must follow on without a gap
STRAIGHT_M = 1e-6       # of a clearance between bodies that rest, turn or drive straight on
CURVED_M = 1e-5         # of a clearance of a body in a bend
ROUNDING_M = 2e-7       # the search of the program ends within 1e-7 m
DRIVE = {"speed_mps": 2.0, "acceleration_mps2": 0.5, "deceleration_mps2": 1.0}
LONGEST_DIFFERENCES = 20

differences = []


def differ(sentence):
    differences.append(sentence)


def check_seams(body):
    """A piece begins where the one before it ended: a body never jumps, and phases follow on."""
    worst = 0.0
    for piece in body.pieces:
        off = math.dist(piece.pose(piece.begin_ns), piece.start)
        for one, other in zip(piece.phases, piece.phases[1:]):
            d = one["end_s"] - one["begin_s"]
            way = one["way"] + d * (one["speed"] + d * one["acceleration"] / 2)
            speed = one["speed"] + d * one["acceleration"]
            off = max(off, abs(way - other["way"]), abs(speed - other["speed"]), abs(one["end_s"] - other["begin_s"]))
        if off > POSE_M:
            differ(f"{body.name}: the piece at {piece.begin_ns} ns is off by {off} within itself")
        worst = max(worst, off)
    for one, other in zip(body.pieces, body.pieces[1:]):
        if one.end_ns != other.begin_ns:
            continue  # it was taken off the floor, or came onto it
        # An end is rounded to a nanosecond: at 2 m/s the body is 1e-9 m short of its station, and then stands there.
        off = math.dist(one.pose(one.end_ns), other.start)
        if off > 3 * POSE_M and one.manner != "turn" or off > 1e-7:
            differ(f"{body.name}: jumps by {off} m at {one.end_ns} ns")
        worst = max(worst, off)
    return worst


def check_poses(bodies, rows):
    """Every row of the CSV against the closed form of its piece."""
    by_name = {body.name: body for body in bodies}
    counts, worst = {"rest": 0, "turn": 0, "line": 0, "bend": 0, "backward": 0, "loaded": 0}, 0.0
    usual = {body.name: min(p.length for p in body.pieces) for body in bodies}
    for row in rows:
        ns = round(float(row["t_s"]) * 1e9)
        piece = by_name[row["body"]].piece(ns)
        told = tuple(float(row[key]) for key in ("x_m", "y_m", "heading_x", "heading_y"))
        off = max(math.dist(piece.pose(ns), told), abs(piece.speed(ns) - float(row["speed_mps"])))
        if off > POSE_M and piece.end_ns == ns:  # at a seam a row may speak of the later piece
            later = by_name[row["body"]].piece(ns + 1)
            if later is not None:
                off = min(off, max(math.dist(later.pose(ns), told), abs(later.speed(ns) - float(row["speed_mps"]))))
        if off > POSE_M:
            differ(f"{row['body']} at {row['t_s']} s: off by {off}")
        worst = max(worst, off)
        counts["bend" if piece.curved else "line" if piece.manner == "drive" else piece.manner] += 1
        counts["backward"] += piece.tail_first
        counts["loaded"] += piece.length > usual[row["body"]]
    return counts, worst


def drive_time(length, speed, up, down):
    """From rest to rest: a trapezoid, or a triangle if the way is short."""
    peak = min(speed, math.sqrt(2 * length * up * down / (up + down)))
    return peak / up + peak / down + (length - peak * peak / (2 * up) - peak * peak / (2 * down)) / peak


def check_durations(bodies, scenario):
    """Drives from rest to rest along a whole straight segment take as long as the law of motion says."""
    types = scenario.get("vehicle_types", [{}])
    named = {t.get("name"): t for t in types}
    checked = 0
    for agv, body in zip(scenario["agvs"], bodies):
        drive = DRIVE | (named[agv["type"]] if "type" in agv else types[0]).get("drive", {})
        for piece in body.pieces:
            if piece.manner != "drive" or piece.curved or piece.way_begin > 0 or piece.phases[0]["speed"] > 0:
                continue
            way, speed = piece.way_and_speed(piece.end_ns)
            if abs(way - piece.track[0].ends[-1]) > 1e-6 or speed > 1e-6:
                continue
            wanted = drive_time(piece.track[0].ends[-1], *(drive[key] for key in DRIVE))
            off = abs((piece.end_ns - piece.begin_ns) * 1e-9 - wanted)
            if off > 1e-9:
                differ(f"{body.name}: the drive at {piece.begin_ns} ns takes {off} s more or less than {wanted} s")
            checked += 1
    return checked


def off_by(gap, told_um):
    """How far a gap lies outside of what a whole number of micrometres, rounded down, stands for."""
    return max(told_um * 1e-6 - gap, gap - (told_um + 1) * 1e-6, 0.0)


def check_clearance(bodies, outcome):
    found, told = smallest_clearance(bodies), outcome["min_clearance_um"]
    if found is None or told is None:
        if told is not None or found is not None:
            differ(f"smallest clearance: {found} from the pieces, {told} um told")
        return "none below 0.5 m"
    gap, at, curved = found
    off = off_by(gap, max(told, 0))
    if off > (CURVED_M if curved else ROUNDING_M):
        differ(f"smallest clearance: {gap} m at {at} ns from the pieces, {told} um told")
    return f"{gap:.9f} m, off by {off:.2g} m{' in a bend' if curved else ''}"


def check_violations(bodies, outcome, safety_m):
    by_name = {body.name: body for body in bodies}
    for violation in outcome["violations"]:
        pair = Pair(*(by_name[name] for name in violation["entities"]))
        at = violation["at_ns"]
        curved = pair.curved(at)
        off = off_by(pair.gap(at), max(violation["min_clearance_um"], 0))
        if off > (CURVED_M if curved else STRAIGHT_M):
            differ(f"{violation['entities']}: {pair.gap(at)} m at {at} ns, {violation['min_clearance_um']} um told")
        # It begins where the safety distance breaks: a moment before, it is kept.
        first = violation["first_ns"]
        slack = CURVED_M * 2 + 4e-6 + pair.fastest(first - 2000, first + 2000) * 2e-6
        if first > 0 and pair.gap(first - 2000) < safety_m - slack:
            differ(f"{violation['entities']}: below {safety_m} m before {first} ns")
        if pair.gap(first) > safety_m + slack:
            differ(f"{violation['entities']}: not below {safety_m} m at {first} ns")
    return len(outcome["violations"])


def main(pieces_file, poses_file, outcome_file, scenario_file=None):
    with open(pieces_file, encoding="utf-8") as file:
        pieces = json.load(file)
    with open(outcome_file, encoding="utf-8") as file:
        outcome = json.load(file)
    bodies = [Body(body) for body in pieces["bodies"]]
    seams = max(check_seams(body) for body in bodies)
    with open(poses_file, encoding="utf-8", newline="") as file:
        counts, poses = check_poses(bodies, csv.DictReader(file))
    drives = 0
    if scenario_file:
        with open(scenario_file, encoding="utf-8") as file:
            drives = check_durations(bodies, json.load(file))
    clearance = check_clearance(bodies, outcome)
    violations = check_violations(bodies, outcome, pieces["safety_distance_m"])
    print("poses: " + ", ".join(f"{number} {word}" for word, number in counts.items()) + f"; off by {poses:.2g} m")
    print(f"seams off by {seams:.2g} m; {drives} durations; {violations} violations; smallest clearance: {clearance}")
    for sentence in differences[:LONGEST_DIFFERENCES]:
        print("DIFFERENCE: " + sentence)
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

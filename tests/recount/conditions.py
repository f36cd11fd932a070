"""What the sections "Conditions" and "Provenance" must say, and which numbers a sample has, from the plan in the
archive."""
import json
import re

import wording as w
from sentences import agv_hours, judged
from waived import waived

MOST = 40  # names and numbers in a list


def plan_of(archive):
    return json.loads(archive.campaign["plan_json"] or "{}")


def distance(value_m):
    return (f"{value_m:.2f}" if float(f"{value_m:.2f}") == value_m else repr(value_m)) + " m"


def safety_distance(archive):
    """As the pages write it; archives without a whole plan have that of a campaign file that says nothing."""
    return distance(plan_of(archive).get("law", {}).get("safety_distance_m", 0.1))


def numbers(values, scale=1.0):
    words = [" to ".join("%g" % (value[end] * scale) for end in ("from", "to")) if isinstance(value, dict)
             else "%g" % (value * scale) for value in (values if isinstance(values, list) else [values])]
    return ", ".join(words[:MOST] + [f"and {len(words) - MOST} more"] * (len(words) > MOST))


def agent(given):
    if isinstance(given, str):
        return given
    return given["name"] + (f" ({given['program']})" if given["program"] != given["name"] else "")


def layout(given):
    name = given if isinstance(given, str) else given["name"]
    content = {} if isinstance(given, str) else given.get("content", {}).get("layout", {})
    kind = (f"given: {len(content['stations'])} stations (nodes), {len(content['segments'])} segments (edges)"
            if content else "drawn anew in each world")
    return f"{name} ({kind}{', mutated' if not isinstance(given, str) and 'mutate' in given else ''})"


def vehicle(given):
    return ("%s: %g m x %g m, %g m/s, accelerates %g m/s², brakes %g m/s², share %g" % tuple(
        given[key] for key in ("name", "length_m", "width_m", "speed_mps", "acceleration_mps2", "deceleration_mps2",
                               "share")))


def radio(given, outages):
    share = given.get("constant_delay_share", 0.0)
    text = f"delay {given['delay_model']}{f' (constant in {w.percent(share)} of the worlds)' if share else ''}, "
    text += (f"losses in outages ({given['outage_model']}, by {given['outage_scope']})" if outages
             else "each loss independent of the others")
    text += f", range {given['range_m']:g} m"
    text += f", duplicates {w.percent(given['duplicates'])}" if given["duplicates"] > 0.0 else ""
    text += ", interference" if given["interference"] else ""
    text += f", {given['sources']:g} outside sources" if given["sources"] > 0 else ""
    return text + (", roaming" if given["roaming_at_crossing"] else "")


def faults(given):
    words = [f"{key.replace('_', ' ')} {value:g}" for key, value in given.items()
             if value and ("_per_" in key or key.startswith(("clock_", "position_")) or key.endswith("_share"))]
    return ", ".join(words) or "none injected"


def conditions(archive):
    """Name -> what stands behind it."""
    campaign, plan = archive.campaign, plan_of(archive)
    said = {}
    if "factors" in plan:
        factors, law = plan["factors"], plan["law"]
        outages = factors["mean_outage_s"] != [0.0]
        left_out = law.get("leave_out", [])
        said = {"Safety distance": safety_distance(archive),
                "Laws (monitors)": "all but " + ", ".join(left_out) if left_out else "all",
                "Agents (control software)": ", ".join(map(agent, factors["agents"])),
                "Loss": numbers(factors["loss"], 100.0) + " %",
                "Delay": numbers(factors["delay_s"]) + " s"}
        if outages:
            said["Mean outage"] = numbers(factors["mean_outage_s"]) + " s (0 = each loss independent of the others)"
        said |= {"Radio": radio(plan["radio"], outages),
                 "Layouts": "; ".join(map(layout, factors["layouts"][:MOST])),
                 "Fleet sizes": numbers(factors["fleet_sizes"]) + " AGVs",
                 "Vehicles": "; ".join(map(vehicle, plan["vehicles"][:MOST])),
                 "Transports (orders)": f"{plan['world']['transports_per_agv_hour']:g} per AGV-hour, placement "
                                        f"{plan['world']['placement']}",
                 "Faults": faults(plan["faults"]),
                 "Safety scanner": "on" if plan["scanner"]["on"] else "off: only the software keeps the distance",
                 "Operator": "clears jams" if plan["operator"]["on"] else "never intervenes",
                 "Horizon of a run": f"{plan['horizon_s']:g} s simulated"}
    if "factors" in plan and waived(plan):
        said["Waived"] = "; ".join(waived(plan))
    return said | {"Cells (test conditions)": str(len(archive.cells)), "Runs": judged(archive),
                   "Simulated": agv_hours(archive),
                   "Software": f"fleetproof {campaign['engine_version']}, sha256 {campaign['program_sha256']}",
                   "Plan digest": f"{campaign['plan_hash'] % 2**64:016x}"}


def provenance(archive):
    """Name -> what stands behind it, but for the name of the archive."""
    campaign = archive.campaign
    return {"campaign": f"{campaign['name']}, kind {campaign['kind']}, seed {campaign['seed'] % 2**64}, "
                        f"{w.count(len(archive.cells), 'cell')}, {w.count(campaign['replicates'], 'planned replicate')}",
            "plan digest": f"{campaign['plan_hash'] % 2**64:016x}", "fleetproof": campaign["engine_version"],
            "program sha256": campaign["program_sha256"],
            **{name: campaign[name] for name in ("compiler", "flags", "libraries")}}


def is_sample(archive, text):
    """"3 worlds wherever loss <= 40 % and ..., fleets of 3 or 5, 120 s a run": worlds, fleets and time are as counted,
    and every other number is one of the cells, or of how many they are."""
    for name in {cell["layout"] for cell in archive.cells}:
        text = text.replace(name, "")
    longest = {w.hundredths(row["ns"] / 1e9) for row in archive.all(
        "SELECT max(simulated_ns) AS ns FROM runs WHERE replicate < ? GROUP BY cell", archive.replicates)}
    time = r"(?:, ([0-9.]+) s a run)?(?:;|\.|$)"
    said = re.search(r"\b([0-9]+) worlds? (.*), fleets of ([0-9 or,]+?)" + time, text)
    fleets = {str(cell["fleet_size"]) for cell in archive.cells}
    if (said is None or int(said[1]) != archive.replicates or (said[4] and said[4] not in longest) or
            not set(re.findall("[0-9]+", said[3])) <= fleets):
        return False
    known = set()
    for cell in archive.cells:
        for i, columns in enumerate((("loss", "loss_to"), ("delay_s", "delay_to_s"),
                                     ("mean_outage_s", "mean_outage_to_s"), ("call_cost_s", "call_cost_to_s"))):
            known |= {w.span(i, cell[column], cell[column]).split()[0] for column in columns}
    known |= {str(i) for i in range(1, len({tuple(cell)[4:] for cell in archive.cells}) + 1)}
    return set(re.findall(r"[0-9]+(?:\.[0-9]+)?", said[2])) <= known

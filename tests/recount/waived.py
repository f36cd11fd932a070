"""What a plan waives, from the plan in the archive and the rules of campaign/fields.md."""
import os
import re

PAGE = os.path.join(os.path.dirname(__file__), "..", "..", "campaign", "fields.md")
UNITS = (("_radps2", "rad/s2"), ("_radps", "rad/s"), ("_mps2", "m/s2"), ("_mps", "m/s"), ("_per_m", "per m"),
         ("_per_byte_s", "s per byte"), ("_per_s", "per s"), ("_per_agv_hour", "per AGV and hour"),
         ("_per_hour", "per hour"), ("_per_transport", "per transport"), ("_ppm", "ppm"), ("_m", "m"), ("_s", "s"))
HEAVIEST = 8
FAR = 1.25  # times the bound; what is closer comes last
ORDER = ("judgement", "plant", "load")


def rules():
    """Key, usual value as the page has it, which values are named, weight: one for each field that has a direction."""
    table = open(PAGE, encoding="utf-8").read().split("fields of campaign files", 1)[1].split("<!-- end -->", 1)[0]
    for line in table.splitlines():
        cells = re.split(r"(?<!\\) \| ", line.strip("| "))
        found = re.fullmatch(r"(.*) \((judgement|plant|load)\)", cells[3]) if len(cells) == 5 else None
        if found:
            yield cells[0].strip("`"), cells[1].strip("`"), found[1], found[2]


def text(value, key):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    unit = next((unit for ending, unit in UNITS if key.endswith(ending)), "")
    return re.sub(r"\.0$", "", repr(float(value))) + (" " + unit if unit else "")


def stated(plan, key):
    """All that the plan says of a field."""
    found = [plan]
    for part in key.split("."):
        is_list = part.endswith("[]")
        names = (part[:-2] + "s", part[:-2]) if is_list else (part,)  # [[gate]] is "gates", [[computers]] has its name
        found = [each[name] for each in found if isinstance(each, dict)
                 for name in names if each.get(name) is not None]
        if is_list:
            found = [item for each in found for item in each]
    if key.startswith("gate[]") and key.endswith("min_transports_per_agv_hour"):
        floors = {}
        for gate in plan["gates"]:
            floors[gate["agent"]] = max(floors.get(gate["agent"], 0.0), gate["min_transports_per_agv_hour"])
        return [floors[gate["agent"]] for gate in plan["gates"]]
    if key == "coverage.probes" or key == "law.leave_out":
        return found
    flat = [item for each in found for item in (each if isinstance(each, list) else [each])]
    return [end for each in flat
            for end in ((each["from"], each["to"]) if isinstance(each, dict) and "from" in each else (each,))]


def usual_of(key, shown, plan):
    if key == "coverage.probes":
        return [] if plan["kind"] == "search" else ["encounter", "negotiation?"]
    shown = shown.strip("[]")
    if shown in ("true", "false"):
        return shown == "true"
    if shown.startswith('"'):
        return shown.strip('"')
    return float(shown) if shown else []


def amount(value):
    return float(len(value)) if isinstance(value, (list, dict)) else float(value)


def is_easier(value, usual, named):
    if isinstance(value, str):
        return value != usual and value not in named.split(", ")[-1].split()
    if named.startswith("any"):
        return amount(value) != amount(usual)
    way, bound, endless = re.fullmatch(r"(above|below) (the default|[-+0-9.e]+)(, (?:and|but) 0)?", named).groups()
    reach = lambda number: float("inf") if endless and number == 0.0 else number
    limit = reach(amount(usual)) if bound == "the default" else float(bound)
    if amount(value) == amount(usual):
        return False
    return reach(amount(value)) > limit if way == "above" else reach(amount(value)) < limit


def bound_of(usual, named):
    found = re.match(r"(?:above|below) ([-+0-9.e]+)", named)
    return float(found[1]) if found else amount(usual)


def distance(value, usual, named):
    """As a factor from the bound; what is no number is far."""
    if isinstance(value, str) or named.startswith("any") or bound_of(usual, named) <= 0.0 or amount(value) <= 0.0:
        return float("inf")
    return max(amount(value) / bound_of(usual, named), bound_of(usual, named) / amount(value))


def shown_value(value, key):
    if isinstance(value, list):
        return "[" + ", ".join(value) + "]"
    return "given" if isinstance(value, dict) else text(value, key)


NONE_ALLOWED, FEW_ALLOWED = ("violation", "crash", "wrong-load"), ("deadlock", "livelock", "starvation", "hang", "throughput")


def has_default_gates(plan):
    """The gates of a claim that names none."""
    of_each = {end_point: [gate for gate in plan["gates"] if gate["end_point"] == end_point]
               for end_point in NONE_ALLOWED + FEW_ALLOWED}
    usual = {"requirement": "", "unit": "world", "method": "any-time", "confidence": 0.95, "layout": "", "fleet_size": None,
             "loss": None, "delay_s": None, "mean_outage_s": None, "call_cost_s": None}
    is_usual = lambda gate: (all(gate.get(key, value) == value for key, value in usual.items())
                             and gate["name"] == f"{gate['agent']} {gate['end_point']}"
                             and (gate["kind"], gate["limit"]) == (("none", 0.01) if gate["end_point"] in NONE_ALLOWED
                                                                   else ("rate", 0.1)))
    return (plan.get("default_gates", True) and all(of_each[each] for each in (NONE_ALLOWED + FEW_ALLOWED)[:7])
            and sum(map(len, of_each.values())) == len(plan["gates"]) and all(map(is_usual, plan["gates"])))


def floor_sentence(plan):
    """How a floor came about that the campaign does not name; empty: it names one."""
    if not has_default_gates(plan):
        return ""
    floor, demand = plan["gates"][0]["min_transports_per_agv_hour"], plan["world"]["transports_per_agv_hour"]
    demand = 0.0 if plan.get("orders") else demand
    if floor == 0.0:
        return "The default gates ask for no throughput: the campaign has no orders, or hardly any."
    text = ("The floor of throughput was not written in the campaign. By default it is "
            f"{floor:g} transports (orders) per AGV-hour: ")
    if demand > 0.0 and floor == int(100.0 * 0.5 * demand) / 100.0:
        return text + f"half of the {demand:g} that the campaign orders."
    text += f"a twentieth of the {floor / 0.05:.3g} that an AGV alone in these warehouses would do"
    text += ", or what is asked for where runs are too short for an order" if floor == 1.0 else ""
    return text + (f"; the campaign orders {demand:g}." if demand > 0.0 else ".")


def waived(plan):
    """The conditions as pages write them, the heaviest first."""
    found, written = [], not has_default_gates(plan)
    for key, shown, named, weight in rules():
        usual, easier, farthest = usual_of(key, shown, plan), [], 0.0
        for value in stated(plan, key):
            words = shown_value(value, key)
            if key == "coverage.probes" and "encounter" not in value:
                value = []  # it asks for nobody
            if is_easier(value, usual, named):
                farthest = max(farthest, distance(value, usual, named))
                easier += [words] * (words not in easier)
        if easier:
            told = shown_value(usual, key) if usual != [] else "none"
            name = key.replace("[]", "")
            name += " of the default gates (not written in the campaign)" if key.startswith("gate[]") and not written else ""
            found.append(((farthest < FAR, ORDER.index(weight), -farthest), f"{name} = {', '.join(easier)} (usual: {told})"))
    return [words for _, words in sorted(found, key=lambda each: each[0])]


def sentence(plan):
    """At the head."""
    words = waived(plan)
    more = f"; and {len(words) - HEAVIEST} more, under Conditions" if len(words) > HEAVIEST else ""
    return f"what is easier here than usual: {'; '.join(words[:HEAVIEST])}{more}." if words else ""

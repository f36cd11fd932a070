"""How the pages write figures."""
from math import ceil, floor, inf, log10

SHOWN = (("loss", 100.0, " %", False), ("delay", 1.0, " s", False), ("outage", 1.0, " s", True),
         ("call cost", 1000.0, " ms", True))


def rate(value):
    return "%.3g" % value


def directed(value, up):
    """Three digits, rounded up or down. A value within 1e-9 of such a number counts as that number."""
    if value in (0.0, inf):
        return "%.3g" % value
    unit = 10.0 ** (floor(log10(value)) - 2)
    parts = value / unit
    near = round(parts)
    steps = near if abs(parts - near) < 1e-9 * parts else (ceil(parts) if up else floor(parts))
    return "%.3g" % (steps * unit)


def up(value):
    return directed(value, True)


def down(value):
    return directed(value, False)


def hundredths(value):
    text = "%.2f" % value
    text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def percent(share):
    return hundredths(100.0 * share) + " %"


def span(factor, low, high):
    _, scale, sign, _ = SHOWN[factor]
    return ("" if low == high else hundredths(low * scale) + " .. ") + hundredths(high * scale) + sign


def named_cells(gate):
    """"layout ring, fleet of 5, loss 40 %, mean outage 0.5 s": what a gate names, or nothing."""
    words = [f"layout {gate['layout']}"] if gate["layout"] else []
    words += [f"fleet of {gate['fleet_size']}"] if gate["fleet_size"] is not None else []
    columns = (("loss", "loss"), ("delay_s", "delay"), ("mean_outage_s", "mean outage"), ("call_cost_s", "call cost"))
    words += [f"{name} {span(i, gate[column], gate[column])}" for i, (column, name) in enumerate(columns)
              if gate[column] is not None]
    return ", ".join(words)


def metres(value_um):
    return "%.2f m" % (value_um // 10000 / 100.0)


def closest(tally):
    if tally["closest_um"] is not None:
        return metres(tally["closest_um"])
    if tally["runs"] == tally["unmeasured"]:
        return "-"
    return "contact" if tally["contact"] > 0 else "> 0.5 m"


def per_hour(done, agv_us):
    return "%.2f" % (done / (agv_us / 3.6e9)) if agv_us else "-"


def count(number, word):
    return f"{number} {word}" + ("" if number == 1 else "s")


def failed(known, with_unknown):
    return str(known) + (f" +{with_unknown - known}?" if with_unknown > known else "")


def of_gate(gate, rounded, value):
    """A share in percent, or a rate per AGV-hour, which may have no bound."""
    if value == inf:
        return "none"
    return rounded(value) + " per AGV-hour" if gate["unit"] == "agv-hour" else rounded(100.0 * value) + " %"


def grouped(number):
    return f"{number:,}".replace(",", " ")


def interval(pair):
    """Of a rate."""
    return f"[{down(pair[0])}, {'no upper bound' if pair[1] == inf else up(pair[1])}]"


def shares(pair):
    return f"[{down(100.0 * pair[0])} %, {up(100.0 * pair[1])} %]"


def share_up(value):
    return up(100.0 * value) + " %"

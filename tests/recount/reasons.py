"""The numbers that may stand in the reason of a verdict."""
import re
from functools import cache
from math import log

import wording as w
from bounds import bounds, fixed_share, largest_share, log_gate
from known_sentences import ENDS


def smallest(is_enough):
    """The smallest whole number that is enough; none below 10^15."""
    high = 1
    while not is_enough(high):
        high *= 2
        if high > 10**15:
            return None
    low = high // 2
    while low + 1 < high:
        middle = (low + high) // 2
        low, high = (low, middle) if is_enough(middle) else (middle, high)
    return high


@cache
def needed(method, failing, units, risk, share):
    if method == "any-time":
        return smallest(lambda n: n >= failing and log_gate(failing, n, share) >= -log(risk))
    return max(smallest(lambda n: n > failing and fixed_share(failing, n, risk)[1] <= share), units + 1)


@cache
def needed_at_this_rate(method, failing, units, risk, share):
    """Units at which the gate passes although units go on to fail as they did."""
    for count in range(failing, 1000):
        wanted = needed(method, count, units, risk, share)
        if wanted is None:
            return None
        if failing * (wanted / units) <= count:
            return max(wanted, units)
    return None


def numbers_of_gate(archive, gate, counts):
    units, known, failing, every, distinct, _, run_hours = counts
    hourly, risk = gate["unit"] == "agv-hour", round(1.0 - gate["confidence"], 12)
    cells = archive.cells_of_gate(gate)
    share = (lambda rounded, value: rounded(value)) if hourly else (lambda rounded, value: rounded(100.0 * value))
    texts = {share("{:g}".format, gate["limit_rate"]), f"{gate['min_transports_per_agv_hour']:g}", str(len(cells)), "0",
             str(archive.replicates), str(archive.campaign["replicates"]), str(failing), str(known),
             str(failing - known), str(failing_runs(archive, gate, cells)), str(units), str(every), str(distinct)}
    bound = lambda k, n: bounds(gate["method"], gate["unit"], k, n, risk, len(cells), run_hours)
    if cells:
        texts |= {share(w.up, bound(failing, units)[1]), share(w.down, bound(known, every)[0]),
                  share(w.up, bound(known, every)[1])}
    if units:
        texts.add(share(w.rate, failing / (units * len(cells) * run_hours if hourly else units)))
    due = [cell for cell in cells if archive.inside(archive.cells[cell])] or cells
    texts.add(str(len(due)))
    tally = archive.tally(due)
    texts.add(w.per_hour(tally["done"], tally["agv_us"]))
    texts.add(str(sum(archive.tally([cell])["done"] == 0 for cell in due)))
    largest = largest_share(gate, run_hours)
    want = needed(gate["method"], failing, units, risk, largest) if cells else None
    if want is not None:
        texts |= {str(want), str(want - units)}
        if failing and units and gate["method"] == "any-time":
            at_this_rate = needed_at_this_rate(gate["method"], failing, units, risk, largest)
            texts |= {str(at_this_rate)} if at_this_rate else set()
    return texts


def failing_runs(archive, gate, cells):
    if gate["end_point"] == "throughput":
        return archive.units("throughput", cells, gate["min_transports_per_agv_hour"])[1]
    complete, archive.replicates = archive.replicates, 10**12  # every run before the first gap
    found = sum(row["result"] == 1 for row in archive.results(gate["end_point"], cells)
                if row["run_index"] < archive.runs)
    archive.replicates = complete
    return found


def unexplained(archive, allowed, text):
    """Numbers of a reason that no gate has; `text` begins after "Why ..."."""
    text = re.sub(r"never met: .*|too rare: .*", "", text)
    serious = re.search(r"(?:Its most serious run|The most serious of the unknown runs) is ([0-9]+) \(", text)
    if serious:
        run = archive.one(f"SELECT {ENDS} AS end FROM runs WHERE run_index = ?", int(serious[1]))
        if not run["end"] and not archive.all("SELECT 1 FROM incidents WHERE run_index = ?", int(serious[1])):
            return [serious[0]]
        text = text[:serious.start()]
    return [number for number in re.findall(r"(?<![\w.])[0-9]+(?:\.[0-9]+)?(?:e-?[0-9]+)?(?![\w])", text)
            if number not in allowed]

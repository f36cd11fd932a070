"""The tables that the pages must show, row by row, from the counts of an archive."""
from collections import defaultdict
from math import inf

import wording as w
from bounds import bounds
from counts import KINDS, UNMEASURED

CONTRACT = "loss <= 40 %, delay <= 2 s"
WHERE = {"contract": CONTRACT, "worst-case": "loss 40 %, delay 2 s", "all": "all cells"}


def rule(archive, agent):
    """Method and confidence of an agent's bounds: those of its first gate."""
    for gate in archive.gates:
        if gate["agent"] == agent:
            return gate["method"], gate["confidence"]
    return "any-time", 0.95


def share(archive, agent, failing, units, unit="world", cells=1, run_hours=0.0):
    method, confidence = rule(archive, agent)
    upper = bounds(method, unit, failing, units, round(1.0 - confidence, 12), cells, run_hours)[1]
    return upper, bounds(method, unit, failing, units, 0.025, cells, run_hours)


def condition_tables(archive):
    """title -> rows, and rows of all conditions by (agent, lowest, highest)."""
    titles = {"Worst case of the contract: 40 % loss, 2 s delay": lambda c: c["loss"] == c["loss_to"] == 0.4
              and c["delay_s"] == c["delay_to_s"] == 2.0,
              "Contract region: loss <= 40 %, delay <= 2 s": archive.inside,
              "Outside the contract": lambda c: not archive.inside(c)}
    shown = [i for i, factor in enumerate(w.SHOWN) if not factor[3]
             or any(cell[high] > 0.0 for cell in archive.cells for high in [("loss_to", "delay_to_s",
                                                                             "mean_outage_to_s", "call_cost_to_s")[i]])]
    tables = {title: [] for title in titles}
    for agent, low, high, cells in archive.conditions():
        indices = [cell["cell"] for cell in cells]
        tally = archive.tally(indices)
        units, known, failing, every, distinct = archive.units("violation", indices)
        row = [agent] + ["none" if w.SHOWN[i][3] and high[i] == 0.0 else w.span(i, low[i], high[i]) for i in shown]
        row += [str(tally["runs"]), str(tally["violating"])]
        if not archive.search:
            upper, pair = share(archive, agent, failing, units)
            row.append(f"{w.failed(known, failing)}/{units}")
            row += ["-"] * 3 if every > 1 >= distinct else [
                w.rate(100.0 * failing / units) + " %" if units else "-", w.shares(pair), w.share_up(upper)]
        row += [str(tally[name]) for name in ("contact", "stuck", "ended")]
        row += [w.closest(tally), w.per_hour(tally["done"], tally["agv_us"])]
        for title, wanted in titles.items():
            if wanted(cells[0]):
                tables[title].append(row)
    return tables


def group_row(archive, agent, name, inside, cells):
    tally = archive.tally(cells)
    units, known, failing, every, distinct = archive.units("violation", cells)
    row = [agent, name, "contract" if inside else "beyond", str(tally["runs"])]
    if archive.search:
        row.append(str(tally["violating"]))
    else:
        says = units > 0 and not every > 1 >= distinct
        row += [f"{w.failed(known, failing)}/{units}", w.share_up(share(archive, agent, failing, units)[0]) if says else "-"]
        hours = archive.run_hours(cells)
        if not says:
            row += ["-", "-"]
        else:
            pair = share(archive, agent, failing, units, "agv-hour", len(cells), hours)[1]
            row += [w.rate(failing / (units * len(cells) * hours)), w.interval(pair)]
    return row + [f"{archive.stalled_worlds(cells)}/{every}", w.per_hour(tally["done"], tally["agv_us"])]


def group_tables(archive):
    tables = {"By layout": [], "By fleet size": []}
    layouts = {cell["layout"] for cell in archive.cells}
    for agent in archive.agents:
        for title, key in (("By layout", None), ("By layout", "layout"), ("By fleet size", "fleet_size")):
            if key is None and len(layouts) == 1:
                continue
            groups = defaultdict(list)
            for cell in archive.cells:
                if cell["agent"] == agent:
                    groups["all" if key is None else cell[key], archive.inside(cell)].append(cell["cell"])
            for (name, inside), cells in groups.items():
                shown = f"{name} AGVs" if key == "fleet_size" else name
                tables[title].append(group_row(archive, agent, shown, inside, cells))
    return tables


def deciding_units(archive, gate, cells):
    """Of the worlds; if each cell is judged for itself, of the cell that refutes the gate, else of the one with the
    highest upper bound."""
    if gate["unit"] != "run":
        return archive.units(gate["end_point"], cells, gate["min_transports_per_agv_hour"])
    counts = archive.by_cell(gate["end_point"], cells, gate["min_transports_per_agv_hour"])
    risk = round(1.0 - gate["confidence"], 12)
    most = max(counts, key=lambda count: count[1])
    if most[3] and bounds(gate["method"], "run", most[1], most[3], risk, len(cells))[0] > gate["limit_rate"]:
        return most
    return max(counts, key=lambda count: (bounds(gate["method"], "run", count[2], count[0], risk)[1], count[2], -count[0],
                                             count[1]))


def sampled(archive, cells):
    """"loss 0 %, 40 %; delay 1 s" of the cells of a gate, "loss 0 % to 40 %" of more than two values, or "loss <= 40 %"
    if they were drawn."""
    own = [cell for cell in archive.cells if cell["cell"] in cells]
    words = []
    for factor, (name, low, high) in enumerate((("loss", "loss", "loss_to"), ("delay", "delay_s", "delay_to_s"))):
        values = sorted({cell[column] for cell in own for column in (low, high)})
        shown = [w.span(factor, value, value) for value in values]
        if any(cell[low] != cell[high] for cell in own):
            words.append(f"{name} <= {shown[-1]}" if values[0] == 0.0 else f"{shown[0]} <= {name} <= {shown[-1]}")
        else:
            words.append(f"{name} " + (f"{shown[0]} to {shown[-1]}" if len(values) > 2 else ", ".join(shown)))
    return "; ".join(words)


def gate_rows(archive):
    """[(row without its verdict, gate, counts)]"""
    rows = []
    for gate in archive.gates:
        cells = archive.cells_of_gate(gate)
        counts = *deciding_units(archive, gate, cells), len(cells), archive.run_hours(cells)
        units, known, failing = counts[:3]
        what = gate["end_point"] + (f" >= {gate['min_transports_per_agv_hour']:g}/AGV-h" if gate["end_point"] ==
                                    "throughput" else "") + (f" [{gate['requirement']}]" if gate["requirement"] else "")
        named = w.named_cells(gate)
        region = sampled(archive, cells) if gate["region"] == "contract" and cells else WHERE[gate["region"]]
        where = ", ".join(filter(None, (region, named)))
        if gate["region"] == "all" and (gate["loss"], gate["delay_s"]) != (None, None):
            where = named
        row = [gate["agent"], what, where]
        if archive.search:
            row.append(None)
        else:
            hourly = gate["unit"] == "agv-hour"
            upper = bounds(gate["method"], gate["unit"], failing, units, round(1.0 - gate["confidence"], 12), len(cells),
                           archive.run_hours(cells))[1] if cells or gate["unit"] != "agv-hour" else inf
            in_unit = lambda text, number: w.of_gate(gate, text, number)
            limit = in_unit(lambda number: f"{number:g}", gate["limit_rate"])
            failed = w.failed(known, failing)
            row += [f"{failed}/{units}", in_unit(w.up, upper),
                    limit + (", none allowed" if gate["kind"] == "none" else "")]
        rows.append((row, gate, counts))
    return rows


ENCOUNTERS = ("head-on", "crossing", "following", "merging")
WORLD = ENCOUNTERS + ("near-miss", "encounter", "safe-mode")


def coverage_rows(archive):
    """What was met, by agent; required probes that nobody met may follow."""
    rows = []
    for agent in archive.agents:
        runs = archive.one("SELECT count(*) AS n FROM runs JOIN cells USING (cell) WHERE agent = ? AND replicate < ?",
                           agent, archive.replicates)["n"]
        met = archive.all(
            "SELECT source, CAST(name AS TEXT) AS name, count(*) AS runs, sum(count) AS times FROM probes JOIN runs "
            "USING (run_index) JOIN cells USING (cell) WHERE agent = ? AND replicate < ? GROUP BY 1, 2", agent,
            archive.replicates)
        by_world = {row["name"]: (row["runs"], row["times"]) for row in met if row["source"] == 0}
        by_agent = {row["name"]: (row["runs"], row["times"]) for row in met if row["source"] != 0
                    and row["name"] not in WORLD and not row["name"].startswith("fault:")}
        marks = ",".join("?" * len(ENCOUNTERS))
        met = archive.one(
            "SELECT count(DISTINCT run_index) AS runs, coalesce(sum(count), 0) AS times FROM probes JOIN runs USING "
            f"(run_index) JOIN cells USING (cell) WHERE agent = ? AND replicate < ? AND source = 0 AND CAST(name AS "
            f"TEXT) IN ({marks})", agent, archive.replicates, *ENCOUNTERS)
        if met["runs"]:
            by_world["encounter"] = (met["runs"], met["times"])
        safe = archive.one("SELECT count(*) AS runs FROM runs JOIN cells USING (cell) WHERE agent = ? AND replicate < ? "
                           "AND safe_mode_ns > 0", agent, archive.replicates)["runs"]
        if safe:
            by_world["safe-mode"] = (safe, safe)
        for by, met in (("world", by_world), ("agent", by_agent)):
            rows += [[agent, name, by, str(met[name][0]), w.percent(met[name][0] / runs), str(met[name][1])]
                     for name in sorted(met)]
    return rows


def incident_rows(archive):
    """Of all runs before the first gap."""
    return [[row["agent"], KINDS[row["kind"]], str(row["runs"]), str(row["incidents"])] for row in archive.all(
        "SELECT agent, kind, count(DISTINCT run_index) AS runs, count(*) AS incidents FROM incidents JOIN runs USING "
        "(run_index) JOIN cells USING (cell) WHERE run_index < ? AND kind NOT IN (18, 19) GROUP BY agent, kind ORDER BY "
        "(SELECT min(cell) FROM cells c WHERE c.agent = cells.agent), kind", archive.runs)]


def clearance_rows(archive):
    """The lower tail, of all runs before the first gap. A clearance has a tolerance of one micrometre."""
    rows = {}
    for agent in archive.agents:
        for inside in (1, 0):
            closer = ", ".join(f"sum(contact OR (min_clearance_um IS NOT NULL AND min_clearance_um + 1 < {limit}))"
                               for limit in (50000, 100000, 110000, 150000, 200000, 500000))
            found = archive.one(
                f"SELECT count(*), sum(contact), {closer}, sum(NOT contact AND {UNMEASURED}) FROM runs r JOIN cells USING (cell) WHERE agent = ? AND "
                "(r.loss <= 0.4 AND r.delay_s <= 2.0) = ? AND run_index < ?", agent, inside, archive.runs)
            if found[0]:
                rows[agent, bool(inside)] = [agent, "contract" if inside else "beyond contract"] + [
                    str(number) for number in found[:8]] + [str(found[0] - found[7] - found[8]), str(found[8])]
    return list(rows.values())

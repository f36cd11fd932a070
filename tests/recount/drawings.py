"""The numbers that the maps and charts of the HTML page must show."""
from collections import defaultdict
from math import ceil, log, log1p

import wording as w
from bounds import beta_cdf, bounds, largest_share, log_gate
from counts import UNMEASURED
from tables import deciding_units, share


def axes(places):
    losses = sorted({(high[0], low[0]) for low, high in places})
    delays = sorted({(high[1], low[1]) for low, high in places})
    return losses, delays


def panels(archive):
    """title -> {(loss, delay): cells}, a panel for each agent and each value of the other factors."""
    found = defaultdict(dict)
    for agent, low, high, cells in archive.conditions():
        title = f"Agent {agent}"
        for i, phrase in ((2, "outages of"), (3, "call cost")):
            if high[i] > 0.0:
                title += f", {phrase} {w.span(i, low[i], high[i])}"
        found[title][low, high] = [cell["cell"] for cell in cells]
    return found


def field_maps(archive):
    """label -> the texts of the fields, row by row from the bottom. Which gates are demonstrated, check_gates has read:
    recount.py compares the bounds of gates elsewhere."""
    maps = {}
    for title, places in panels(archive).items():
        agent = title.split(",")[0].removeprefix("Agent ")
        losses, delays = axes(places)
        by_place = {((high[0], low[0]), (high[1], low[1])): cells for (low, high), cells in places.items()}
        risk, done, safe = [], [], []
        for loss in losses:
            for delay in delays:
                cells = by_place.get((loss, delay))
                if not cells or archive.replicates == 0:
                    continue
                units, _, failing, every, distinct = archive.units("violation", cells)
                tally = archive.tally(cells)
                risk.append(f"{failing}/{units}")
                same = every > 1 >= distinct
                risk.append("counts only" if archive.search else "always the same" if same else
                            "≤ " + w.share_up(share(archive, agent, failing, units)[0]))
                if tally["agv_us"]:
                    done.append(w.per_hour(tally["done"], tally["agv_us"]))
                if tally["all_ns"]:
                    safe.append(w.percent(tally["safe_mode_ns"] / tally["all_ns"]))
        maps["Upper bound of the failure rate. " + title] = risk
        maps["Transports per AGV-hour. " + title] = done
        maps["Share of time in safe mode. " + title] = safe
        envelope = envelope_fields(archive, agent, losses, delays, by_place)
        if envelope is not None:
            maps["Guaranteed envelope. " + title] = envelope
    return maps


def gate_on_violations(archive, agent):
    for gate in archive.gates:
        if (gate["agent"], gate["end_point"], w.named_cells(gate)) == (agent, "violation", "") \
                and gate["unit"] != "agv-hour" and 0.0 < gate["limit_rate"] < 1.0:
            return gate
    return None


def grids(archive, agent):
    """(rows, columns) of the panels of an agent, in the order of field_maps."""
    sizes = []
    for title, places in panels(archive).items():
        if title.split(",")[0] == f"Agent {agent}":
            losses, delays = axes(places)
            sizes.append((len(losses), len(delays)))
    return sizes


def worlds_needed(archive, gate, parts):
    """Without a failure, in each field, when the risk is shared by so many."""
    risk = round(1.0 - gate["confidence"], 12) / parts
    limit = largest_share(gate, archive.run_hours(archive.cells_of_gate(gate)))
    if gate["method"] == "fixed":
        return ceil(log(risk) / log1p(-limit))
    worlds = 1
    while log_gate(0, worlds, limit) < -log(risk):
        worlds += 1
    return worlds


def envelope_fields(archive, agent, losses, delays, by_place):
    gate = gate_on_violations(archive, agent)
    if gate is None or archive.search or any(high != low for pair in (*losses, *delays) for high, low in [pair]):
        return None
    if gate["method"] == "fixed" and archive.replicates < archive.campaign["replicates"]:
        return None
    risk = round(1.0 - gate["confidence"], 12) / min(len(losses), len(delays))
    own = set(archive.cells_of_gate(gate)) if gate["gate"] in archive.demonstrated else set()
    units, _, failing, *_ = deciding_units(archive, gate, archive.cells_of_gate(gate))
    bound = w.share_up(bounds(gate["method"], gate["unit"], failing, units, round(1.0 - gate["confidence"], 12),
                              len(archive.cells_of_gate(gate)))[1])
    limit, texts, claimed = gate["limit_rate"], [], {}
    for r, loss in enumerate(losses):
        for d, delay in enumerate(delays):
            cells = by_place.get((loss, delay), [])
            units, _, failing, *_ = archive.units("violation", cells)
            if units == 0:
                enough = False
            elif gate["method"] == "any-time":
                enough = log_gate(failing, units, limit) >= -log(risk)
            else:  # P(Binomial(units, limit) <= failing)
                enough = failing < units and 1.0 - beta_cdf(limit, failing + 1, units - failing) <= risk
            of_gate = bool(own) and bool(cells) and set(cells) <= own
            claimed[r, d] = of_gate or enough and claimed.get((r - 1, d), True) and claimed.get((r, d - 1), True)
            if units:
                texts += [f"≤ {bound}", f"gate, {failing}/{units}"] if of_gate else \
                    [f"< {100.0 * limit:g} %" if claimed[r, d] else "open", f"{failing}/{units}"]
    return texts


def clearance_bars(archive):
    """label -> the counts of the bars that are not empty: contact, then each centimetre below 0.5 m."""
    bars = {}
    for agent in archive.agents:
        for inside, region in ((1, "contract"), (0, "beyond contract")):
            rows = archive.all(
                f"SELECT CASE WHEN contact THEN -1 WHEN {UNMEASURED} THEN 98 WHEN min_clearance_um IS NULL OR "
                "min_clearance_um + 1 >= 500000 THEN 99 ELSE max(min_clearance_um + 1, 0) / 10000 END AS step, count(*) AS runs FROM runs r JOIN cells "
                "USING (cell) WHERE agent = ? AND (r.loss <= 0.4 AND r.delay_s <= 2.0) = ? AND run_index < ? GROUP BY 1 "
                "ORDER BY 1", agent, inside, archive.runs)
            steps = {row["step"]: row["runs"] for row in rows}
            if steps:
                far, unmeasured = steps.pop(99, 0), steps.pop(98, 0)
                runs = sum(steps.values()) + far + unmeasured
                label = f"Agent {agent}, {region}: {w.count(runs, 'run')}, {far} never closer than 0.5 m" + (
                    f", {unmeasured} not measured" if unmeasured else "")
                bars[label] = [f"{count} runs" for count in steps.values()]
    return bars

"""The sentences with numbers that the pages must contain."""
import re
from math import inf

import wording as w
from bounds import bounds
from counts import END_POINTS

FAILURES = {"violation": "broke the safety distance", "contact": "had a contact",
            "hazardous-contact": "had a contact at hazardous speed", "deadlock": "deadlocked",
            "livelock": "moved without a result (livelock)",
            "starvation": "left an AGV or an order without progress (starvation)",
            "standstill": "stood still while the radio kept its contract", "wrong-load": "handled a load wrongly",
            "empty-battery": "let a battery run empty", "crash": "crashed", "hang": "hung"}


def title(archive):
    campaign, planned = archive.campaign, archive.campaign["replicates"]
    complete = f"INCOMPLETE: {archive.replicates} of {w.count(planned, 'planned replicate')}"
    if archive.replicates >= planned:
        complete = w.count(archive.replicates, "replicate") + " complete"
    judged = archive.replicates * len(archive.cells)
    return (f"fleetproof report: {campaign['name']} ({campaign['kind']}), {complete} of {len(archive.cells)} cells "
            f"each, {w.count(judged, 'run')} judged")


def counted(gate, counts):
    _, _, _, every, distinct, cells, run_hours = counts
    text = f" ({every * cells * run_hours:.6g} AGV-hours)" if gate["unit"] == "agv-hour" else ""
    return text + (f", {distinct} distinct" if distinct < every else "")


def gate_sentence(gate, counts):
    """What the remark about a gate must begin with."""
    units, known, failing, every, _, cells, run_hours = counts
    hourly, risk = gate["unit"] == "agv-hour", round(1.0 - gate["confidence"], 12)
    exposure = units * cells * run_hours if hourly else units
    upper = bounds(gate["method"], gate["unit"], failing, units, risk, cells, run_hours)[1]
    pair = bounds(gate["method"], gate["unit"], failing, units, 0.025, cells, run_hours)
    text = f"\"{gate['name']}\": {known} of {every} UNIT{counted(gate, counts)} failed"
    if failing > known:
        text += f" and {failing - known} stayed unknown, which counts as failing"
    if units:
        text += f": {w.of_gate(gate, w.rate, failing / exposure)}, " if failing else ": "
        text += "two-sided 95 % interval " + (w.interval(pair) + " per AGV-hour" if hourly else w.shares(pair))
    when = "valid however often one looks" if gate["method"] == "any-time" else "for the planned worlds"
    return text + (f", one-sided {w.percent(gate['confidence'])} upper bound {w.of_gate(gate, w.up, upper)}, limit "
                   f"{w.of_gate(gate, '{:g}'.format, gate['limit_rate'])} ({when}).")


def subject(gate, distance):
    """How the claim about a gate begins, as a pattern with that of the distance. Gates on the same end point differ in
    the cells they name."""
    named = w.named_cells(gate)
    of = f" of {distance}" if gate["end_point"] == "violation" else ""
    return (re.escape(f"{gate['agent']} {FAILURES[gate['end_point']]}") + of + " " +
            (re.escape(f"({named}) ") if named else "(?![(])"))


def finding(gate, counts, verdict, distance):
    """The claim about a gate in the head of the page, as a pattern."""
    units, known, failing, every, _, cells, run_hours = counts
    if gate["end_point"] not in FAILURES:
        return None
    hourly = gate["unit"] == "agv-hour"
    text = subject(gate, distance)
    text += re.escape(f"in {known} of {every} ") + "(runs|worlds)" + re.escape(counted(gate, counts))
    if failing > known:
        text += re.escape(f", and {failing - known} more ended unknown and count as failing")
    violated = verdict == "violated"
    if (every if violated else units) == 0:
        return text
    risk = round(1.0 - gate["confidence"], 12)
    lower = bounds(gate["method"], gate["unit"], known, every, risk, cells, run_hours)[0]
    upper = bounds(gate["method"], gate["unit"], failing, units, risk, cells, run_hours)[1]
    if violated and lower <= 0.0:
        return text
    if not violated and upper == inf:
        return text + re.escape("; every world may fail, so that the true rate has no upper bound "
                                f"({w.percent(gate['confidence'])})")
    number = w.down(lower if hourly else 100.0 * lower) if violated else w.up(upper if hourly else 100.0 * upper)
    bound = f"; the true {'rate' if hourly else 'share'} is at {'least' if violated else 'most'} {number}"
    bound += " per AGV-hour" if hourly else " %"
    when = ", however often one looks" if gate["method"] == "any-time" else ""
    return text + re.escape(bound + f" ({w.percent(gate['confidence'])}{when})")


def agv_hours(archive):
    us = archive.one("SELECT coalesce(sum(simulated_ns / 1000 * agv_count), 0) AS us FROM runs WHERE replicate < ?",
                     archive.replicates)["us"]
    return f"{us / 3.6e9:.1f} AGV-hours, of all agents and cells"


def judged(archive):
    return (f"{archive.runs} judged, {archive.replicates} of "
            f"{w.count(archive.campaign['replicates'], 'planned replicate')} complete")


def violation_headlines(archive):
    """agent -> runs that broke the distance within the contract, of the agents under test."""
    rows = archive.all(f"SELECT agent, count(*) AS runs FROM runs r JOIN cells USING (cell) WHERE "
                       f"({END_POINTS['violation']}) = 1 AND r.loss <= 0.4 AND r.delay_s <= 2.0 AND run_index < ? GROUP BY agent", archive.runs)
    return [f"agent {row['agent']} broke the safety distance in {w.count(row['runs'], 'run')} within the contract region"
            for row in rows if archive.is_under_test(row["agent"])]


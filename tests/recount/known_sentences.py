"""What the remaining sentences may say: patterns, each with a check of its numbers against the archive.

A sentence with digits that no pattern knows is an error, so that no figure reaches a page without a check.
"""
import re

import wording as w
from bounds import bounds
from conditions import is_sample, plan_of
from counts import END_POINTS, KINDS
from drawings import field_maps, gate_on_violations, grids, worlds_needed
from leading import failures, rows_of
from tables import coverage_rows, rule, share
from waived import floor_sentence, sentence

ENDS = "CASE WHEN contact THEN 'contact' WHEN violation THEN 'violation' WHEN crash THEN 'crash' WHEN hang THEN 'hang' " \
       "WHEN indeterminate THEN 'indeterminate' WHEN engine_error THEN 'engine error' WHEN stuck THEN 'stuck' END"


def body(number, run):
    fleet = run["fleet_size"]
    return f"AGV {number}" if number < fleet else f"fallen load or obstacle {number - fleet}"


def run_sentence(archive, index):
    """The description of a failing run, up to its message."""
    run = archive.one(f"SELECT r.*, {ENDS} AS end, agent, layout, fleet_size FROM runs r JOIN cells USING (cell) WHERE "
                      "run_index = ?", index)
    text = f"run {index}: "
    if run["end"]:
        text += run["end"]
    else:
        text += KINDS[failures(run, *rows_of(archive.db, index))[0]["kind"]]
    violations = archive.all("SELECT * FROM violations WHERE run_index = ? ORDER BY contact DESC, CASE WHEN contact "
                             "THEN -relative_speed_um_s ELSE min_clearance_um END, ordinal", index)
    if violations:
        worst = violations[0]
        if worst["contact"] and worst["relative_speed_um_s"] > 300000:
            text += f" at hazardous speed ({worst['relative_speed_um_s'] // 100000 / 10:.1f} m/s)"
        text += (f", {w.metres(worst['min_clearance_um'])} at {worst['closest_at_ns'] // 10**6 / 1000:.3f} s between "
                 f"{body(worst['entity_a'], run)} and {body(worst['entity_b'], run)}")
        if len(violations) > 1:
            text += f" (the worst of {len(violations)})"
    text += f"; agent {run['agent']}, layout {run['layout']}, fleet of {run['fleet_size']}, "
    values = (run["loss"], run["delay_s"], run["mean_outage_s"], run["call_cost_s"])
    phrases = ("loss", "delay", "outages of", "call cost")
    return text + ", ".join(f"{phrases[i]} {w.span(i, value, value)}" for i, value in enumerate(values)
                            if value > 0.0 or i < 2)


def is_waived(archive, found):
    return found[1] == sentence(plan_of(archive))


def is_floor(archive, found):
    return found.string == floor_sentence(plan_of(archive))


def is_run(archive, found):
    return found[0].startswith(run_sentence(archive, int(found[1])))


def is_first_with_kind(archive, found):
    kind = next(number for number, name in KINDS.items() if name == found[1])
    first = archive.one("SELECT min(run_index) AS n FROM incidents JOIN runs USING (run_index) JOIN cells USING (cell) "
                        "WHERE agent = ? AND kind = ?", found[2], kind)["n"]
    return first == int(found[3])


def is_audit(archive, found):
    row = archive.one("SELECT count(*) AS n, coalesce(sum(a.checksum = r.checksum), 0) AS same FROM audits a JOIN runs r "
                      "USING (run_index) JOIN cells USING (cell) WHERE agent = ? AND run_index < ?", found[1],
                      archive.runs)
    return row["n"] == row["same"] == int(found[2])


WEAK = {"always have the same run": "count(r.run_index) > 1 AND count(DISTINCT r.digest) = 1", "have no run": "count(run_index) = 0",
        "have stuck runs": "coalesce(sum(stuck), 0) > 0",
        "completed no transport": "count(run_index) > 0 AND coalesce(sum(transports_done), 0) = 0"}


def is_weak_point(archive, found):
    """"48 of 81 cells in the contract region have stuck runs: A on ring, fleet of 3, 0 %, 2 s; ...; and 44 more."."""
    inside = "WHERE loss_to <= 0.4 AND delay_to_s <= 2.0" if found[3] else ""
    having = next((sql for words, sql in WEAK.items() if words in found.string), None)
    if having is None:
        having = f"coalesce(sum({EARLY_UNKNOWN}), 0) > 0"
    cells = archive.all("SELECT c.* FROM cells c LEFT JOIN runs r ON r.cell = c.cell AND "
                        f"replicate < {archive.replicates} {inside} GROUP BY c.cell HAVING {having} ORDER BY c.cell")
    of = archive.one(f"SELECT count(*) AS n FROM cells {inside}")["n"]
    if (len(cells), of) != (int(found[1]), int(found[2])):
        return False
    if len(cells) == of:
        return ": " not in found.string
    more = f"; and {len(cells) - NAMED} more" if len(cells) > NAMED else ""
    return found.string.endswith(": " + "; ".join(map(cell_name, cells[:NAMED])) + more + ".")


NAMED = 4  # cells in a sentence


def cell_name(cell):
    values = [w.span(0, cell["loss"], cell["loss_to"]), w.span(1, cell["delay_s"], cell["delay_to_s"])]
    values += [f"{word} {w.span(i, cell[column], cell[to])}"
               for i, word, column, to in ((2, "outages of", "mean_outage_s", "mean_outage_to_s"),
                                           (3, "call cost", "call_cost_s", "call_cost_to_s")) if cell[to] > 0.0]
    return f"{cell['agent']} on {cell['layout']}, fleet of {cell['fleet_size']}, " + ", ".join(values)


EARLY_UNKNOWN = f"({END_POINTS['violation']}) = 2"


def probes_missing(archive, found):
    """"too rare: NAME (3 of 900 runs)"."""
    runs = archive.one("SELECT count(*) AS n FROM runs JOIN cells USING (cell) WHERE agent = ? AND replicate < ?",
                       found[1], archive.replicates)["n"]
    return all(int(of) == runs for of in re.findall(r"\([0-9]+ of ([0-9]+) runs\)", found.string))


def engine_errors(archive, found):
    return int(found[1]) == archive.one("SELECT coalesce(sum(engine_error), 0) AS n FROM runs WHERE run_index < ?",
                                        archive.runs)["n"]


def is_envelope(archive, found):
    agent = found[4]
    gates = [gate_on_violations(archive, name) for name in ([agent] if agent else archive.agents)]
    return any(gate and is_envelope_of(archive, gate, found.groups()) for gate in gates)


def is_envelope_of(archive, gate, told):
    shown, fields, with_gate, _, bound, alone, limit, confidence, any_time, worlds, best, needed = told
    agent = gate["agent"]
    maps = [texts for label, texts in field_maps(archive).items()
            if label.startswith(f"Guaranteed envelope. Agent {agent}")]
    # Which of the panels of an agent a sentence belongs to is not said; one of them must have these numbers.
    counts = {(sum(text.startswith("gate, ") for text in texts), sum(text.startswith("< ") for text in texts), grid)
              for texts, grid in zip(maps, grids(archive, agent))}
    bounds_shown = {text for texts in maps for text in texts if text.startswith("≤ ")}
    rows_columns = {size for size in grids(archive, agent) if str(size[0] * size[1]) == fields}
    parts = (int(with_gate or 0), int(alone or 0))
    limits = (f"{100.0 * gate['limit_rate']:g}", w.percent(gate["confidence"]), gate["method"] == "any-time")
    return ((alone is None or (limit, confidence, bool(any_time)) == limits)
            and int(shown) == sum(parts) and (bound is None or f"≤ {bound}" in bounds_shown)
            and (worlds is None or int(worlds) == archive.replicates)
            and any((*parts, size) in counts and is_best(archive, gate, min(size), best)
                    and worlds_needed(archive, gate, min(size)) == int(needed) for size in rows_columns))


def is_best(archive, gate, parts, told):
    """The bound of so many worlds without a failure, when the risk is shared."""
    risk = round(1.0 - gate["confidence"], 12) / parts
    return told is None or told == w.share_up(bounds(gate["method"], "world", 0, archive.replicates, risk)[1])


def best_bound(archive, found):
    """"With 32 worlds and no failure, the upper bound of a row by itself is 10 % (95 %) or 14 % (99 %)."."""
    expected = {f"{w.share_up(share(archive, agent, 0, archive.replicates)[0])} ({w.percent(rule(archive, agent)[1])})"
                for agent in archive.agents}
    return int(found[1]) == archive.replicates and set(found[2].split(" or ")) == expected


def foreign_body_runs(archive, found):
    return int(found[1]) == archive.one(
        f"SELECT count(*) AS n FROM runs r JOIN cells USING (cell) WHERE agent = ? AND r.loss <= 0.4 AND r.delay_s <= 2.0 "
        f"AND run_index < ? AND (violation OR contact) AND ({END_POINTS['violation']}) != 1", found[2],
        archive.runs)["n"]


def plan_time(archive, found):
    return found[1] == f"{archive.campaign['plan_hash'] % 2**64:016x}"


def seed(archive, found):
    return int(found[1]) == archive.campaign["seed"] % 2**64


def layouts(archive, found):
    """"Layouts as units: runs of A failed or stayed unknown on 2 of 4 layouts (design effect 3.10). ... 4 units"."""
    runs = [(row["failing"], row["n"]) for row in archive.all(
        f"SELECT layout, count(*) AS n, sum(({END_POINTS['violation']}) != 0) AS failing FROM (SELECT r.*, layout FROM "
        "runs r JOIN cells USING (cell) WHERE agent = ? AND loss_to <= 0.4 AND delay_to_s <= 2.0 AND replicate < ?) r "
        "GROUP BY layout", found[1], archive.replicates)]
    rate, units = sum(f for f, _ in runs) / sum(n for _, n in runs), sum(n for _, n in runs)
    counted = (sum(f > 0 for f, _ in runs), len(runs), len(runs)) == (int(found[2]), int(found[3]), int(found[5]))
    if found[4] is None:
        return counted and rate in (0.0, 1.0)
    spread = len(runs) / (len(runs) - 1) * sum((f - rate * n) ** 2 for f, n in runs) / units**2
    return counted and abs(spread / (rate * (1.0 - rate) / units) - float(found[4])) <= 0.0051


def stalled(archive, found):
    """"A stalled in 12 of 32 worlds of the contract region"."""
    cells = [cell["cell"] for cell in archive.cells if cell["agent"] == found[1] and archive.inside(cell)]
    return (archive.stalled_worlds(cells), archive.replicates) == (int(found[2]), int(found[3]))


def met_nobody(archive, found):
    """"In 12 of 32 runs of A no two AGVs met"."""
    runs = archive.one("SELECT count(*) AS n FROM runs JOIN cells USING (cell) WHERE agent = ? AND replicate < ?",
                       found[3], archive.replicates)["n"]
    met = sum(int(row[3]) for row in coverage_rows(archive) if row[:2] == [found[3], "encounter"])
    return (runs - met, runs) == (int(found[1]), int(found[2]))


def crashed(archive, found):
    """"A crashed in 12 of 32 runs of the contract region"."""
    cells = [str(cell["cell"]) for cell in archive.cells if cell["agent"] == found[1] and archive.inside(cell)]
    kind = "crash" if found[2] == "crashed" else "hang"
    row = archive.one(f"SELECT coalesce(sum({kind}), 0) AS n, count(*) AS runs FROM runs WHERE run_index < ? AND cell IN "
                      f"({','.join(cells)})", archive.runs)
    return (row["n"], row["runs"]) == (int(found[3]), int(found[4]))


def soundness(archive, found):
    row = archive.one("SELECT (SELECT count(*) FROM audits WHERE run_index < ?) AS n, (SELECT coalesce(sum(engine_error), "
                      "0) FROM runs WHERE run_index < ?) AS errors, (SELECT count(*) FROM audits a JOIN runs r USING "
                      "(run_index) WHERE a.checksum != r.checksum) AS differing", archive.runs, archive.runs)
    return (row["n"], row["errors"], row["differing"]) == (int(found[1]), 0, 0)


def silence(archive, found):
    """"The AGVs of A sent no message in 3 of 9 runs with two or more of them: ..."."""
    row = archive.one("SELECT count(*) AS n, coalesce(sum(agv_count > 1 AND messages_sent = 0), 0) AS silent FROM runs JOIN "
                      "cells USING (cell) WHERE agent = ? AND fleet_size > 1 AND replicate < ?", found[1], archive.replicates)
    return (row["silent"], row["n"]) == (int(found[2]), int(found[3]))


def repeats_alike(archive, found):
    """"With 95 % confidence, at most 9.22 % of the runs of A would come out otherwise ...: 31 were, and none did."."""
    audited = archive.one("SELECT count(*) AS n FROM audits JOIN runs USING (run_index) JOIN cells USING (cell) WHERE agent = ? "
                          "AND run_index < ?", found[3], archive.runs)["n"]
    confidence = next((gate["confidence"] for gate in archive.gates if gate["agent"] == found[3]), 0.95)
    share = 1.0 - round(1.0 - confidence, 12) ** (1.0 / audited)
    return (found[1], found[2], int(found[4])) == (w.percent(confidence), w.up(100.0 * share), audited)


def confidences(archive, found):
    """"upper = one-sided upper bound, at 95 % for A, 99 % for B."."""
    said = [f"{w.percent(next((gate['confidence'] for gate in archive.gates if gate['agent'] == agent), 0.95))} for {agent}"
            for agent in archive.agents]
    return found[1] == ", ".join(said)


def is_confidence(archive, found):
    return found[1] in ["95 %", *(w.percent(gate["confidence"]) for gate in archive.gates)]


def gates_by_verdict(archive, found):
    """"Gates of A: violated: hang; demonstrated: violation (fleet of 5), crash (3 gates). Gates of B: ..."."""
    rest = found.string
    for agent in archive.agents:
        for end_point in (*END_POINTS, "throughput"):
            gates = [gate for gate in archive.gates
                     if gate["decides"] and (gate["agent"], gate["end_point"]) == (agent, end_point)]
            of_agent = re.search(rf"Gates of {re.escape(agent)}: (.*?)(?=Gates of|Reported only|$)", found.string)
            told = re.findall(rf"(?<![\w-]){end_point}(?: \((.*?)\))?(?=[,;.])", of_agent[1] if of_agent else "")
            numbers = [int(text.split()[0]) if re.fullmatch("[0-9]+ gates", text) else 1 for text in told]
            named = {text for text in told if text and not text.endswith(" gates")}
            if sum(numbers) != len(gates) or not named <= {w.named_cells(gate) for gate in gates}:
                return False
            for text in filter(None, told):
                rest = rest.replace(f"({text})", "")
        rest = rest.replace(agent, "")
    return not re.search("[0-9]", rest)


def sample(archive, found):
    return is_sample(archive, found.string)


def short_gate(archive, found):
    """"every cell of it has 3 runs; even without a failure a limit of 0.01 at 95 % takes 337"."""
    gates = [gate for gate in archive.gates if gate["name"] == found[1]]
    return any((int(found[2]), found[3], found[4]) == (archive.replicates, w.of_gate(gate, "{:g}".format, gate["limit_rate"]),
                                                       w.percent(gate["confidence"]))
               and int(found[5]) == worlds_needed(archive, gate, 1) for gate in gates)


def planned(archive, found):
    return (int(found[1]), int(found[2])) == (archive.replicates, archive.campaign["replicates"])


def uncounted(archive, found):
    stored = archive.one("SELECT count(*) AS n FROM runs")["n"]
    return (int(found[1]), int(found[2])) == (stored - archive.replicates * len(archive.cells), stored)


def repeating(archive, found):
    repeated = archive.one("SELECT count(*) AS n FROM temp.repeating WHERE run_index < ?", archive.runs)["n"]
    return (int(found[1]), int(found[2])) == (repeated, archive.runs)


def unjudged(archive, found):
    """"A broke the safety distance in 3 cells in the contract region for which no gate asks"."""
    judged = {cell for gate in archive.gates if gate["decides"] and
              gate["end_point"] in ("violation", "contact", "hazardous-contact") for cell in archive.cells_of_gate(gate)}
    of_agent = [cell for cell in archive.cells if cell["agent"] == found[1]]
    due = [cell for cell in of_agent if archive.inside(cell)] or of_agent
    count = sum(cell["cell"] not in judged and archive.tally([cell["cell"]])["violating"] > 0 for cell in due)
    return found[2] == ("a cell" if count == 1 else f"{count} cells") and bool(found[3]) == archive.inside(due[0])


def agent_runs(archive, found):
    return int(found[2]) == archive.one("SELECT count(*) AS n FROM runs JOIN cells USING (cell) WHERE agent = ? AND "
                                        "replicate < ?", found[1], archive.replicates)["n"]


def longest_run(archive, found):
    tally = archive.tally([cell["cell"] for cell in archive.cells])
    return found[1] == w.hundredths(tally["longest_ns"] / 1e9)


def compared_elsewhere(archive, found):
    return True


def constant(archive, found):
    """Every number of the sentence stands in its pattern."""
    return set(NUMBER.findall(found.string)) <= set(NUMBER.findall(found.re.pattern.replace("\\", "")))


NUMBER = re.compile(r"[0-9]+(?:[.,][0-9]+)*")

PATTERNS = [(re.compile(pattern), check) for pattern, check in (
    (r"^run ([0-9]+): .*", is_run),
    (r"^([a-z-]+) of agent (.+), for instance in run ([0-9]+):", is_first_with_kind),
    (r"^Agent (.+): ([0-9]+) runs? w(?:as|ere) audited, and ", is_audit),
    (r"^([0-9]+) of ([0-9]+) cells (in the contract region )?\D", is_weak_point),
    (r"^Gates of .+: (?:not )?(?:demonstrated|violated): ", gates_by_verdict),
    (r"^(?:waived \| )?(what is easier here than usual: .*)", is_waived),
    (r"Sampled: .*[0-9]+ worlds?\b", sample),
    (r"weak evidence for agent (.+): its ([0-9]+) runs? did not meet", agent_runs),
    (r"A run takes up to ([0-9.]+) s\. stalled", longest_run),
    (r"^([0-9]+) of ([0-9]+) planned replicates? (?:is|are) complete", planned),
    (r"^([0-9]+) of ([0-9]+) stored runs are not counted", uncounted),
    (r"^Not demonstrated in any case: (.+) broke the safety distance in (a cell|[0-9]+ cells)( in the contract region)? for "
     r"which no gate asks\.$", unjudged),
    (r"^([0-9]+) of ([0-9]+) runs have a trace that an earlier run of their cell had\.$", repeating),
    (r"\bin ([0-9]+) runs? of agent (.+) within the contract region, all that AGVs came too close to were fallen loads",
     foreign_body_runs),
    (r"^(.+) stalled in ([0-9]+) of ([0-9]+) worlds of the contract region: ", stalled),
    (r"^(.+) (crashed|hung) in ([0-9]+) of ([0-9]+) runs of the contract region\. No gate judges", crashed),
    (r"^The floor of throughput was not written in the campaign\. ", is_floor),
    (r"^In ([0-9]+) of ([0-9]+) runs of (.+) no two AGVs met\.$", met_nobody),
    (r"^.+ only followed other AGVs: fewer than one in 20000 runs had ", constant),
    (r"^No run ended in an error of the simulator\. ([0-9]+) runs? w(?:as|ere) simulated once more", soundness),
    (r"^The AGVs of (.+) sent no message in ([0-9]+) of ([0-9]+) runs with two or more of them: ", silence),
    (r"^With ([0-9.]+ %) confidence, at most ([0-9.e+-]+) % of the runs of (.+) would come out otherwise if they were simulated "
     r"once more: ([0-9]+) w(?:as|ere), and none did\.$", repeats_alike),
    (r"^Plan digest ([0-9a-f]{16}) was fixed before run 0, at ", plan_time),
    (r"^When plan digest ([0-9a-f]{16}) was fixed is not known", plan_time),
    (r"^Seed ([0-9]+) (was chosen by a person|follows from)", seed),
    (r"^The data (?:obey the plan|are a part of the plan): ([0-9]+) of ([0-9]+) planned", planned),
    (r"^Layouts as units: runs of (.+) failed or stayed unknown on ([0-9]+) of ([0-9]+) layouts(?: \(design effect, by which .*: "
     r"([0-9.]+)\))?\. A claim about layouts that were not run has ([0-9]+) units", layouts),
    # From files beside the archive: contract/campaigns/attempt_ledgers_test.cpp and reports/attempts_test.cpp.
    (r"^Earlier attempts unknown: the ledger names no other", compared_elsewhere),
    (r"^The ledger names [0-9]+ attempts", compared_elsewhere),
    (r"^The results were looked at with [0-9]+ numbers of runs", compared_elsewhere),
    (r"^[0-9]+ more gates?: the reasons stand below", compared_elsewhere),
    # In recount.py: the title, the claim, the gates, the headlines, the charts.
    (r"^fleetproof report: ", compared_elsewhere),
    (r"(the true (share|rate) is at (most|least)|in 0 of 0 (worlds|runs)|in [0-9]+ runs?)\b.*gates? ", compared_elsewhere),
    (r"^\".*\": [0-9.]+ (of [0-9]+ (worlds|runs)( \([0-9.e+]+ AGV-hours\))?(, [0-9]+ distinct)? failed|runs? failed)", compared_elsewhere),
    (r"broke the safety distance in [0-9]+ runs? within the contract region", compared_elsewhere),
    (r"^Agent .*: [0-9]+ runs?, [0-9]+ never closer than 0.5 m(, [0-9]+ not measured)?$", compared_elsewhere),
    (r"^agent .*: ([0-9]+, the last new one in run [0-9]+ of [0-9]+|none)$", compared_elsewhere),
    (r"^.* \(agent .*, limit ", compared_elsewhere),
    (r"^.*: (contact|violation|crash|hang|indeterminate|engine error|stuck|incident); leading failure: ", compared_elsewhere),
    (r"^The runs of agent (.+?): (?:never met|too rare): ", probes_missing),
    (r"^([0-9]+) runs? ended in an error of the simulator itself", engine_errors),
    (r"^Guaranteed envelope: shown in ([0-9]+) of ([0-9]+) fields\. (?:([0-9]+) as parts of the gate \".*\": .* in which (.+) "
     r"breaks the safety distance is at most ([0-9.e-]+ %) in all of them together, with [0-9.]+ % confidence.*?\. )?"
     r"(?:([0-9]+) by (?:its|their) own worlds: there the share is below ([0-9.e-]+) %, in all of them together, with "
     r"([0-9.]+ %) confidence(, however often one looks)?(?:; this is a statement of its own)?\. )?.*?(?: By itself, with ([0-9]+) worlds? "
     r"and no failure, a field shows at most ([0-9.e-]+ %)\.)? Because such fields are claimed together, each needs "
     r"([0-9]+) worlds? without a failure\.$", is_envelope),
    (r"^With ([0-9]+) worlds? and no failure, the upper bound of a row by itself is (.*)\. A gate over several cells ",
     best_bound),
    (r"^Gate \"(.*)\": every cell of it has ([0-9]+) runs?; even without a failure a limit of ([0-9.e-]+ (?:%|per AGV-hour)) at "
     r"([0-9.]+ %) takes ([0-9]+)\.$", short_gate),
    (r"^[^:]*: newly failing: [0-9]+ runs?; newly passing: ", compared_elsewhere),
    (r"^Newly failing: run [0-9]+", compared_elsewhere),
    (r"^[0-9]+ more newly failing runs", compared_elsewhere),
    (r", compared with .* in .*: (both ran in the same|[0-9]+ worlds of each|nothing can be told)", compared_elsewhere),
    (r"^before, now = .* \(95 % confidence on either side, .* less than 90 % of .* below the margin of 5 %", constant),
    # Constants of the method and of the contract.
    (r"^Required: at least one in 20000 runs has to meet ", constant),
    (r"upper = one-sided upper bound at ([0-9.]+ %)", is_confidence),
    (r"upper = one-sided upper bound, at ([0-9.]+ % for .+)\.$", confidences),
    (r"^0 \.\. 40 % = every replicate draws", constant),
    (r"Thick lines: the bounds of the contract, 40 % loss and 2 s delay", constant),
    (r"Clearances above 0\.5 m are not told apart", constant),
    (r"The upper bound is the largest limit that the release gate \(an e-value, Ville 1939\)", constant),
    (r"minimal safety distance \(0\.10 m unless the scenario says otherwise\)\. Clearances are rounded down to 1 cm; "
     r"\"> 0\.5 m\" .* loss <= 40 % and delay <= 2 s\.", constant),
    (r"ISO 3691-4", constant),
    (r"^Runs with an unknown outcome stand here, too\. End point = .* above 0\.3 m/s", constant),
    (r"95 % is how often this procedure is right", constant),
    (r"40 % loss and 2 s delay are stress", constant),
    (r"^(plan digest|fleetproof|program sha256|compiler|flags|libraries|archive|campaign): ", compared_elsewhere),
    (r"^No film strip: ", compared_elsewhere),
    (r"^Agent .*, (outages of|call cost) ", compared_elsewhere),
    (r"^... ?[0-9]+ more", compared_elsewhere),
    (r"^[0-9]+ (more )?(rows?|groups?|with fewer failures)", compared_elsewhere),
)]


def explained(archive, text):
    for pattern, check in PATTERNS:
        found = pattern.search(text)
        if found:
            return check(archive, found)
    return False

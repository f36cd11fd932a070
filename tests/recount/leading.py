"""Which failure leads a run: a rule of its own, from the rows of a results file.

What the software answers for comes first; then contact at hazardous speed, contact, violation, wrong load, crash, hang,
what keeps the fleet from its work or its energy until the end of the run, and the same if it had passed; then the
earliest. `fleetproof replay --json` has the same list."""
from counts import KINDS

WRONG_LOAD, LACKS, EMPTY = (4, 5, 6, 7, 8, 9), (10, 13, 14, 16), 1
RANKS = ("hazardous-contact", "contact", "violation", "wrong-load", "crash", "hang", "lasting", "passed", "none")


def pair(a, b, agvs):
    if a is None and b is None:
        return ""
    if a is None or b is None:
        return ", one body"
    return ", two AGVs" if agvs == 0 or max(a, b) < agvs else ", AGV and another body"


def level(violation):
    if not violation["contact"]:
        return "safety distance broken"
    return "contact at hazardous speed" if violation["relative_speed_um_s"] > 300000 else "contact"


LEVELS = {"contact at hazardous speed": "hazardous-contact", "contact": "contact", "safety distance broken": "violation"}


def answered_for(violations, agvs):
    """By violation, in order of its beginning: False with a load or an obstacle, or with an AGV that still touches one."""
    lies_until, answers = {}, []
    for row in violations:
        bodies = (row["entity_a"], row["entity_b"])
        tainted = any((agvs > 0 and body is not None and body >= agvs) or
                      (body in lies_until and row["first_ns"] <= lies_until[body]) for body in bodies)
        answers.append(not tainted)
        if tainted and row["contact"]:
            for body in bodies:
                lies_until[body] = max(lies_until.get(body, 0), row["last_ns"])
    return answers


def incident_failures(run, violations, incidents):
    end, early = run["simulated_ns"], run["crash"] or run["hang"] or run["indeterminate"] or run["engine_error"]
    wreck = min((row["first_ns"] for row in violations if row["contact"]), default=None)
    lying = [row for row in incidents if row["kind"] == 19]
    for row in incidents:
        kind = row["kind"]
        if kind != EMPTY and kind not in WRONG_LOAD + LACKS:
            continue
        judged = True
        if kind in LACKS:
            began = row["last_ns"] if kind in (13, 14) else row["first_ns"]
            lay = any(b["first_ns"] < row["last_ns"] and b["last_ns"] > row["first_ns"] for b in lying)
            judged = not early and (wreck is None or began < wreck) and not lay
        rank = "wrong-load" if kind in WRONG_LOAD else "lasting" if row["last_ns"] >= end else "passed"
        yield {"what": KINDS[kind] + pair(row["entity_a"], row["entity_b"], run["agv_count"]), "at": row["first_ns"],
               "a": row["entity_a"], "b": row["entity_b"], "judged": judged, "rank": rank, "too_close": False,
               "kind": kind}


def failures(run, violations, incidents):
    """All that went wrong, the failure that leads first."""
    end, found = run["simulated_ns"], []
    for row, answers in zip(violations, answered_for(violations, run["agv_count"])):
        found.append({"what": level(row) + pair(row["entity_a"], row["entity_b"], run["agv_count"]),
                      "at": row["first_ns"], "a": row["entity_a"], "b": row["entity_b"], "judged": answers,
                      "rank": LEVELS[level(row)], "too_close": True, "kind": None})
    of_incidents = list(incident_failures(run, violations, incidents))
    found += of_incidents

    def add(what, rank, judged=True):
        found.append({"what": what, "at": end, "a": None, "b": None, "judged": judged, "rank": rank, "too_close": False,
                      "kind": None})
    if not violations and run["contact"]:
        add("contact", "contact")
    elif not violations and run["violation"]:
        add("violation", "violation")
    for flag in ("crash", "hang"):
        if run[flag]:
            add(flag, flag)
    for flag in ("engine_error", "indeterminate"):
        if run[flag]:
            add(flag, "none", False)
    if run["stuck"] and not of_incidents:
        add("stuck", "none", False)
    return sorted(found, key=lambda failure: (not failure["judged"], RANKS.index(failure["rank"]), failure["at"]))


def rows_of(db, index):
    """The violations and the incidents of a run, each in order."""
    return tuple(db.execute(f"SELECT * FROM {table} WHERE run_index = ? ORDER BY ordinal", (index,)).fetchall()
                 for table in ("violations", "incidents"))

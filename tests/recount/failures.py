"""Failing runs by agent, end point and leading failure, and when each kind was seen first."""
from collections import defaultdict

from known_sentences import ENDS
from leading import EMPTY, LACKS, WRONG_LOAD, failures, rows_of
from tables import ENCOUNTERS, WORLD

SERIOUS = ("contact", "violation", "crash", "hang", "indeterminate", "engine error", "stuck", "incident")


def rank_of(violation):
    """The least is the worst: contacts by speed, hazardous ones first; else by clearance."""
    if not violation["contact"]:
        return 0, violation["min_clearance_um"]
    return -2 if violation["relative_speed_um_s"] > 300000 else -1, -violation["relative_speed_um_s"]


NOTHING, KNOWN, FOREIGN, UNDECIDED = ("no injected fault", "a fault that the software could know of",
                                     "a fallen load or an obstacle, of which no software is told", "faults; which of them matter is not known")
LOAD_DROP = 3


def before(run, faults, at_ns, a, b, is_violation):
    """What the scenario had done to the bodies before."""
    agvs = run["agv_count"]
    foreign = [body is not None and agvs > 0 and body >= agvs for body in (a, b)]
    named = a is not None and (b is not None or not foreign[0])
    earlier = [fault for fault in faults if fault["first_ns"] <= at_ns]
    found = NOTHING
    for fault in earlier:
        if named and fault["entity_a"] in (a, b):
            kind = FOREIGN if fault["kind"] == 19 else UNDECIDED if fault["value"] == LOAD_DROP else KNOWN
            found = max(found, kind, key=(NOTHING, KNOWN, FOREIGN, UNDECIDED).index)
    if any(foreign):
        return FOREIGN
    unnoted = run["faults"] > 0 and not faults
    return UNDECIDED if found == NOTHING and (earlier or unnoted) and not is_violation else found


def failing_runs(archive):
    """(agent, end point, leading failure, before, run) in order of run index."""
    judged = ", ".join(str(kind) for kind in (EMPTY, *WRONG_LOAD, *LACKS))
    listed = {row[0] for row in archive.db.execute("SELECT DISTINCT run_index FROM violations UNION SELECT DISTINCT "
                                                   f"run_index FROM incidents WHERE kind IN ({judged})")}
    for run in archive.db.execute(f"SELECT r.*, {ENDS} AS end, agent FROM runs r JOIN cells USING (cell) WHERE "
                                  "run_index < ? ORDER BY run_index", (archive.runs,)):
        if not run["end"] and run["run_index"] not in listed:
            continue
        violations, incidents = rows_of(archive.db, run["run_index"])
        found = failures(run, violations, incidents)
        if not found:
            continue
        leads = found[0]
        faults = [row for row in incidents if row["kind"] in (18, 19)]
        came_before = before(run, faults, leads["at"], leads["a"], leads["b"], leads["too_close"] and leads["b"] is not None)
        yield run["agent"], run["end"] or "incident", leads["what"], came_before, run


def ordinal_of(archive, agent, run):
    """The number of the run among those of its agent, from 1."""
    own = [cell["cell"] for cell in archive.cells if cell["agent"] == agent]
    return run["replicate"] * len(own) + own.index(run["cell"]) + 1


class Failures:
    def __init__(self, archive):
        self.archive = archive
        self.groups = {}
        self.last_new = defaultdict(int)  # by agent: the number of its run in which a kind was seen first, the latest
        digests = defaultdict(set)
        worst_violation = {}
        for row in archive.db.execute("SELECT * FROM violations"):
            index = row["run_index"]
            worst_violation[index] = min(rank_of(row), worst_violation.get(index, (1, 0)))
        self.kinds = set()  # the charts do not tell what came before
        for agent, end, cause, came_before, run in failing_runs(archive):
            key = (agent, end, cause, came_before)
            if key[:3] not in self.kinds:
                self.last_new[agent] = ordinal_of(archive, agent, run)
            self.kinds.add(key[:3])
            count, worst = self.groups.get(key, (0, None))
            clearance = run["min_clearance_um"] if run["min_clearance_um"] is not None else 2**63
            rank = (worst_violation.get(run["run_index"], (0, 0)), clearance, run["run_index"])
            self.groups[key] = (count + 1, min(rank, worst or rank))
            digests[key].add(run["digest"])
        self.distinct = {key: len(found) for key, found in digests.items()}

    def under_test(self, agent):
        return self.archive.is_under_test(agent)

    def rows(self):
        keys = sorted(self.groups, key=lambda key: (not self.under_test(key[0]), SERIOUS.index(key[1]),
                                                    self.groups[key][1]))
        return [[*key, str(self.groups[key][0]), str(self.distinct[key]), str(self.groups[key][1][-1])] for key in keys]


def situations(archive, agent):
    """name -> the first run that met it; the names are those of the table of what the runs met."""
    first, rows = {}, archive.all(
        "SELECT run_index, source, CAST(name AS TEXT) AS name FROM probes JOIN runs USING (run_index) JOIN cells USING "
        "(cell) WHERE agent = ? AND run_index < ? ORDER BY run_index", agent, archive.runs)
    for row in rows:
        if row["source"] == 0 or not (row["name"] in WORLD or row["name"].startswith("fault:")):
            first.setdefault(row["name"], row["run_index"])
        if row["source"] == 0 and row["name"] in ENCOUNTERS:
            first.setdefault("encounter", row["run_index"])
    safe = archive.one("SELECT min(run_index) AS n FROM runs JOIN cells USING (cell) WHERE agent = ? AND run_index < ? "
                       "AND safe_mode_ns > 0", agent, archive.runs)["n"]
    return first if safe is None else {**first, "safe-mode": safe}


def discoveries(archive, failures):
    """The legends of the two charts of what was new, as texts."""
    found = []
    for agent in archive.agents:
        runs = archive.one("SELECT count(*) AS n FROM runs JOIN cells USING (cell) WHERE agent = ? AND run_index < ?",
                           agent, archive.runs)["n"]
        if runs == 0:
            continue
        kinds = sum(kind[0] == agent for kind in failures.kinds)
        met = situations(archive, agent)
        latest = max(met.values(), default=None)
        last_met = None if latest is None else ordinal_of(
            archive, agent, archive.one("SELECT * FROM runs WHERE run_index = ?", latest))
        for number, last in ((kinds, failures.last_new[agent]), (len(met), last_met)):
            found.append(f"agent {agent}: " + (f"{number}, the last new one in run {last} of {runs}" if number
                                               else "none"))
    return found

"""What an archive holds, counted with SQL from its tables. No code of the product."""
import json
import sqlite3
from collections import defaultdict

FACTORS = (("loss", "loss_to"), ("delay_s", "delay_to_s"), ("mean_outage_s", "mean_outage_to_s"),
           ("call_cost_s", "call_cost_to_s"))
KINDS = {1: "battery-empty", 2: "channel-saturated", 3: "interference-losses", 4: "load-held-by-two",
         5: "load-vanished", 6: "load-delivered-twice", 7: "load-picked-by-full-agv", 8: "load-at-wrong-station",
         9: "load-moved-by-nobody", 10: "deadlock", 11: "waits", 12: "waits-inferred", 13: "livelock",
         14: "starvation", 15: "safe-mode-in-contract", 16: "standstill-in-contract", 17: "throughput-below-floor",
         18: "fault-injected", 19: "foreign-body", 20: "fault-without-effect", 21: "load-did-not-fall",
         22: "obstacle-without-room", 23: "call-not-made", 24: "not-reached"}
UNMEASURED = "(min_clearance_um IS NULL AND (engine_error OR simulated_ns = 0))"  # no clearance is known
EARLY = "(crash OR hang OR indeterminate OR engine_error)"

NEVER = 2**62

# By run: whether each end point failed (1), stayed unknown (2) or neither (0). Behind the first contact a lack of
# progress is a consequence, hence unknown. While a foreign body (a fallen load, an obstacle) lay on the floor, nobody
# knows what the fleet waited for.
def progress(kind):
    lay = ("EXISTS (SELECT 1 FROM incidents b WHERE b.run_index = r.run_index AND b.kind = 19 AND b.first_ns < i.last_ns "
           "AND b.last_ns > i.first_ns)")
    of_kind = f"SELECT 1 FROM incidents i WHERE i.run_index = r.run_index AND i.kind = {kind}"
    began = "last_ns" if kind in (13, 14) else "first_ns"  # livelock and starvation are dated from the last progress
    before = f"EXISTS ({of_kind} AND {began} < w AND NOT {lay})"
    behind = f"EXISTS ({of_kind} AND ({began} >= w OR {lay}))"
    return f"CASE WHEN {before} AND NOT {EARLY} THEN 1 WHEN {behind} OR {EARLY} OR w < {NEVER} THEN 2 ELSE 0 END"


# The software answers for violations that have no row in temp.foreign. A run without rows has its flags alone.
def violation(condition, flags):
    rows = f"SELECT 1 FROM violations v WHERE v.run_index = r.run_index AND {condition}"
    own = (f"EXISTS ({rows} AND NOT EXISTS (SELECT 1 FROM temp.foreign_bodies f WHERE f.run_index = v.run_index AND "
           "f.ordinal = v.ordinal))")
    bare = "NOT EXISTS (SELECT 1 FROM violations v WHERE v.run_index = r.run_index)"
    return f"CASE WHEN {own} OR ({flags} AND {bare}) THEN 1 WHEN EXISTS ({rows}) OR {EARLY} THEN 2 ELSE 0 END"


def failed_or(failed):
    return f"CASE WHEN {failed} THEN 1 WHEN {EARLY} THEN 2 ELSE 0 END"


def incident(condition):
    return failed_or(f"EXISTS (SELECT 1 FROM incidents i WHERE i.run_index = r.run_index AND {condition})")


END_POINTS = {
    "violation": violation("1", "(r.violation OR r.contact)"),
    "contact": violation("v.contact", "r.contact"),
    "hazardous-contact": violation("v.contact AND v.relative_speed_um_s > 300000", "0"),
    "deadlock": progress(10), "livelock": progress(13), "starvation": progress(14), "standstill": progress(16),
    "wrong-load": incident("i.kind BETWEEN 4 AND 9"), "empty-battery": incident("i.kind = 1"),
    "crash": failed_or("crash"), "hang": failed_or("hang")}


class Archive:
    def __init__(self, path):
        self.db = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
        self.db.row_factory = sqlite3.Row
        self.campaign = self.one("SELECT * FROM campaign")
        self.cells = self.all("SELECT * FROM cells ORDER BY cell")
        self.gates = self.all("SELECT * FROM gates ORDER BY gate")
        self.demonstrated = set()  # of these, as the page says
        self.runs = self.one("SELECT coalesce((SELECT min(run_index) + 1 FROM runs r WHERE NOT EXISTS "
                             "(SELECT 1 FROM runs n WHERE n.run_index = r.run_index + 1)), 0) AS n "
                             "WHERE EXISTS (SELECT 1 FROM runs WHERE run_index = 0) UNION ALL SELECT 0 LIMIT 1")["n"]
        self.replicates = self.runs // max(1, len(self.cells))
        self.search = self.campaign["kind"] == "search"
        self.agents = list(dict.fromkeys(cell["agent"] for cell in self.cells))
        self.db.execute(
            "CREATE TEMP TABLE wrecks AS SELECT run_index, min(first_ns) AS w FROM violations WHERE contact "
            "GROUP BY run_index")
        self.db.execute("CREATE UNIQUE INDEX temp.by_run ON wrecks(run_index)")
        self.note_foreign_bodies()
        # Runs with a trace that an earlier run of their cell had.
        self.db.execute("CREATE TEMP TABLE repeating AS SELECT run_index FROM (SELECT run_index, row_number() OVER "
                        "(PARTITION BY cell, digest ORDER BY run_index) AS nth FROM runs) WHERE nth > 1")
        self.db.execute("CREATE UNIQUE INDEX temp.by_repeating ON repeating(run_index)")

    def is_under_test(self, agent):
        named = self.campaign["agents_under_test"].split("\n")[:-1]
        deciding = {gate["agent"] for gate in self.gates if gate["decides"]}
        return agent in named if named else not deciding or agent in deciding

    def run_hours(self, cells):
        """Planned AGV-hours of one run, mean over the cells."""
        horizon_s = json.loads(self.campaign["plan_json"]).get("horizon_s", 0.0) if self.campaign["plan_json"] else 0.0
        fleets = [self.cells[cell]["fleet_size"] for cell in cells]
        return horizon_s / 3600.0 * sum(fleets) / len(fleets) if fleets else 0.0

    def note_foreign_bodies(self):
        """Violations with a body that is no AGV, or with an AGV that hit one before and lies there; and runs with any
        such body."""
        self.db.execute("CREATE TEMP TABLE foreign_bodies (run_index, ordinal, PRIMARY KEY (run_index, ordinal))")
        self.db.execute("CREATE TEMP TABLE met_foreign (run_index INTEGER PRIMARY KEY)")
        hit = "agv_count > 0 AND (entity_a >= agv_count OR entity_b >= agv_count)"
        wrecks, run = {}, None  # until when they touch what they hit
        for row in self.all(f"SELECT v.*, agv_count FROM violations v JOIN runs USING (run_index) WHERE run_index IN "
                            f"(SELECT run_index FROM violations JOIN runs USING (run_index) WHERE {hit}) ORDER BY "
                            "run_index, first_ns, ordinal"):
            if row["run_index"] != run:
                wrecks, run = {}, row["run_index"]
            pair = {row["entity_a"], row["entity_b"]}
            if max(pair) >= row["agv_count"] or any(wrecks.get(body, -1) >= row["first_ns"] for body in pair):
                self.db.execute("INSERT INTO temp.foreign_bodies VALUES (?, ?)", (run, row["ordinal"]))
                for body in pair if row["contact"] else ():
                    wrecks[body] = max(wrecks.get(body, -1), row["last_ns"])
        self.db.execute("INSERT INTO temp.met_foreign SELECT run_index FROM incidents WHERE kind = 19 UNION "
                        f"SELECT run_index FROM violations JOIN runs USING (run_index) WHERE {hit}")

    def all(self, query, *values):
        return self.db.execute(query, values).fetchall()

    def one(self, query, *values):
        return self.all(query, *values)[0]

    def inside(self, cell):
        return cell["loss_to"] <= 0.4 and cell["delay_to_s"] <= 2.0

    def results(self, end_point, cells):
        """(replicate, run, cell, result, agv_us, transports, repeats) of the complete replicates, in order."""
        listed = ",".join(str(cell) for cell in cells) or "-1"
        what = END_POINTS[end_point] if end_point != "throughput" else failed_or("crash")
        return self.db.execute(
            f"SELECT replicate, r.run_index, cell, {what} AS result, simulated_ns / 1000 * agv_count AS agv_us, "
            "transports_done, EXISTS (SELECT 1 FROM temp.met_foreign m WHERE m.run_index = r.run_index) AS foreign_body, "
            "EXISTS (SELECT 1 FROM temp.repeating t WHERE t.run_index = r.run_index) AS repeats "
            f"FROM (SELECT runs.*, coalesce(w, {NEVER}) AS w FROM runs LEFT JOIN temp.wrecks "
            f"USING (run_index)) r WHERE cell IN ({listed}) AND replicate < {self.replicates} ORDER BY r.run_index")

    def units(self, end_point, cells, floor=0.0):
        """Of the worlds of the complete replicates: (those that a claim counts, failing, failing or unknown, all,
        distinct). A world that passed counts if one of its runs is new to its cell."""
        failing = unknown = counted = distinct = 0
        replicate, worst, agv_us, done, foreign, is_new = None, 0, 0, 0, 0, False

        def close():
            nonlocal failing, unknown, counted, distinct
            result = worst
            if end_point == "throughput" and result == 0:
                result = 2 if agv_us == 0 else int(done / (agv_us / 3.6e9) < floor) * (1 + foreign)
            failing += result == 1
            unknown += result == 2
            counted += result != 0 or is_new
            distinct += is_new

        for row in self.results(end_point, cells):
            if row["replicate"] != replicate:
                if replicate is not None:
                    close()
                replicate, worst, agv_us, done, foreign, is_new = row["replicate"], 0, 0, 0, 0, False
            result = row["result"]
            if end_point == "throughput" and result:
                result = 2
            worst = 1 if 1 in (worst, result) else max(worst, result)
            agv_us += row["agv_us"]
            done += row["transports_done"]
            foreign |= row["foreign_body"]
            is_new |= not row["repeats"]
        if replicate is not None:
            close()
        return counted, failing, failing + unknown, self.replicates if cells else 0, distinct

    def by_cell(self, end_point, cells, floor):
        """The same of the runs of each cell."""
        counts = {cell: [0, 0, 0, 0, 0] for cell in cells}
        for row in self.results(end_point, cells):
            result = row["result"]
            if end_point == "throughput":
                hours = row["agv_us"] / 3.6e9
                result = 2 if result or hours == 0.0 else int(row["transports_done"] / hours < floor) * (
                    1 + row["foreign_body"])
            count = counts[row["cell"]]
            count[0] += result != 0 or not row["repeats"]
            count[1] += result == 1
            count[2] += result != 0
            count[3] += 1
            count[4] += not row["repeats"]
        return [tuple(count) for count in counts.values()] or [(0, 0, 0, 0, 0)]

    def stalled_worlds(self, cells):
        worlds = set()
        for kind in ("deadlock", "livelock", "starvation"):
            worlds |= {row["replicate"] for row in self.results(kind, cells) if row["result"] == 1}
        return len(worlds)

    def tally(self, cells):
        """Sums over the complete replicates."""
        listed = ",".join(str(cell) for cell in cells) or "-1"
        return self.one(
            f"SELECT count(*) AS runs, coalesce(sum(({END_POINTS['violation']}) = 1), 0) AS violating, "
            "coalesce(sum(contact), 0) AS contact, coalesce(sum(stuck), 0) AS stuck, "
            "coalesce(sum(crash) + sum(hang), 0) AS ended, min(min_clearance_um) AS closest_um, "
            f"coalesce(sum({UNMEASURED}), 0) AS unmeasured, "
            "coalesce(sum(transports_done), 0) AS done, coalesce(sum(simulated_ns / 1000 * agv_count), 0) AS agv_us, "
            "coalesce(sum(safe_mode_ns), 0) AS safe_mode_ns, coalesce(sum(simulated_ns * agv_count), 0) AS all_ns, "
            "coalesce(max(simulated_ns), 0) AS longest_ns "
            f"FROM runs r WHERE cell IN ({listed}) AND replicate < {self.replicates}")

    def repeats(self, cells):
        """Runs of these cells that repeat an earlier one, of the complete replicates."""
        listed = ",".join(str(cell) for cell in cells) or "-1"
        return self.one(f"SELECT count(*) AS n FROM runs JOIN temp.repeating USING (run_index) WHERE cell IN ({listed}) AND "
                        f"replicate < {self.replicates}")["n"]

    def conditions(self):
        """[(agent, lowest factors, highest factors, cells)]: agents in their order, then by factors."""
        pools = defaultdict(list)
        for cell in self.cells:
            key = (self.agents.index(cell["agent"]), tuple(cell[low] for low, _ in FACTORS),
                   tuple(cell[high] for _, high in FACTORS))
            pools[key].append(cell)
        return [(self.agents[key[0]], key[1], key[2], cells) for key, cells in sorted(pools.items(), key=lambda p: p[0])]

    def cells_of_gate(self, gate):
        def covered(cell):
            if cell["agent"] != gate["agent"] or gate["layout"] not in ("", cell["layout"]):
                return False
            if gate["fleet_size"] not in (None, cell["fleet_size"]):
                return False
            if any(gate[low] is not None and not cell[low] == cell[high] == gate[low] for low, high in FACTORS):
                return False
            at_worst = all(cell[name] == value for name, value in
                           (("loss", 0.4), ("loss_to", 0.4), ("delay_s", 2.0), ("delay_to_s", 2.0)))
            return {"contract": self.inside(cell), "worst-case": at_worst, "all": True}[gate["region"]]
        return [cell["cell"] for cell in self.cells if covered(cell)]

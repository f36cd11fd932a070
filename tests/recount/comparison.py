"""The comparison with a baseline: pairs of worlds, and what may be said of them at any time."""
import wording as w

END_POINTS = ("violation", "contact", "deadlock", "livelock", "starvation", "wrong-load", "crash", "hang", "throughput")
RISK, MARGIN, STEPS = 0.05, 0.05, 4096
PASSED, FAILED, UNKNOWN = 0, 1, 2


def agents_under_test(archive):
    return [agent for agent in archive.agents if archive.is_under_test(agent)]


def cells_of(archive, agent):
    return [cell["cell"] for cell in archive.cells if cell["agent"] == agent]


class World:
    """One replicate of one release: its result at the end point, its work, and whether a run of it is new to its cell."""

    def __init__(self):
        self.result, self.transports, self.agv_us, self.is_new, self.is_known = PASSED, 0, 0, False, True

    def is_slower_than(self, other):
        return self.transports * other.agv_us * 10 < other.transports * self.agv_us * 9


def worlds_of(archive, agent, end_point):
    worlds = [World() for _ in range(archive.replicates)]
    for row in archive.results(end_point if end_point != "throughput" else "crash", cells_of(archive, agent)):
        world = worlds[row["replicate"]]
        if end_point != "throughput" and row["result"] != PASSED and world.result != FAILED:
            world.result = row["result"]
        world.transports += row["transports_done"]
        world.agv_us += row["agv_us"]
        world.is_known &= row["agv_us"] > 0
        world.is_new |= not row["repeats"]
    return worlds


def pairs_of(old, new, agent, end_point):
    """(result before, result now, whether the pair is new) of each replicate that both have."""
    pairs = []
    for before, now in zip(worlds_of(old, agent, end_point), worlds_of(new, agent, end_point)):
        results = before.result, now.result
        if end_point == "throughput":
            results = (int(before.is_slower_than(now)) if before.is_known else UNKNOWN,
                       int(now.is_slower_than(before)) if now.is_known else UNKNOWN)
        pairs.append((*results, before.is_new or now.is_new))
    return pairs


def differences(pairs, in_doubt_for_old):
    """New minus old. What is unknown may have been anything: it counts for the old release, or for the new one."""
    for before, now, is_new in pairs:
        most_now, least_before = now != PASSED, before == FAILED
        least_now, most_before = now == FAILED, before != PASSED
        yield (most_now - least_before if in_doubt_for_old else least_now - most_before), is_new


def shows(steps, bets):
    """Whether the mean of the three products reaches 1 / RISK at some time. Steps: what speaks for the claim."""
    money = [1.0] * len(bets)
    for step, is_new in steps:
        if step > 0.0 and not is_new:
            continue
        money = [each * (1.0 + bet * step) for each, bet in zip(money, bets)]
        if sum(money) / len(money) * (1.0 - 1e-6) >= 1.0 / RISK:
            return True
    return False


def not_worse_by(margin, found):
    return shows([(margin - difference, is_new) for difference, is_new in found], (0.25, 0.5, 1.0))


def bound(found):
    low, high = 0, STEPS
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if not_worse_by(middle / STEPS, found) else (middle, high)
    return high / STEPS


def signed(share, upwards):
    text = w.directed(abs(100.0 * share), upwards == (share >= 0.0))
    return ("-" if share < 0.0 else "+") + text


def counted(results):
    failed, unknown = results.count(FAILED), results.count(UNKNOWN)
    return f"{failed} + {unknown}" if unknown else str(failed)


def row_of(old, new, agent, end_point, may_tell, in_doubt):
    """The row of an end point, without the number of worlds that would tell."""
    pairs = pairs_of(old, new, agent, end_point)
    most, least = list(differences(pairs, True)), list(differences(pairs, False))
    change = "cannot tell"
    if may_tell and shows(least, (0.25, 0.5, 0.9)):
        change = "worse"
    elif may_tell and not in_doubt and shows([(-step, is_new) for step, is_new in most], (0.25, 0.5, 0.9)):
        change = "improved"
    elif may_tell and not in_doubt and not_worse_by(MARGIN, most):
        change = "not worse within the margin"
    only_old = sum(before == FAILED and now != FAILED for before, now, _ in pairs)
    only_new = sum(now == FAILED and before != FAILED for before, now, _ in pairs)
    lower, upper = -bound([(-step, is_new) for step, is_new in least]), bound(most)
    return [agent, end_point, change, counted([pair[0] for pair in pairs]), counted([pair[1] for pair in pairs]),
            str(only_old), str(only_new), f"[{signed(lower, False)}, {signed(upper, True)}]"]


def newly_failing(old, new, agent):
    """Runs of the new release that fail at an end point where the run of the old one did not; and how many pass that
    did not before."""
    worlds = min(old.replicates, new.replicates)
    results = []  # by release: place -> result by end point
    runs = {}
    for archive in (old, new):
        own, found = cells_of(archive, agent), {}
        for end_point in END_POINTS[:-1]:
            for row in archive.results(end_point, own):
                if row["replicate"] < worlds:
                    place = row["replicate"], own.index(row["cell"])
                    found.setdefault(place, {})[end_point] = row["result"]
                    runs[place] = row["run_index"]
        results.append(found)
    before, now = results
    failing = {place for place in now if any(now[place][point] == FAILED and before[place][point] != FAILED
                                             for point in now[place])}
    passing = [place for place in now if place not in failing and not any(now[place].values())
               and any(before[place].values())]
    return sorted(runs[place] for place in failing), len(passing)

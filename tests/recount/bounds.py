"""Bounds and intervals, written from the formulas of the method notes and from no code of the product."""
from functools import cache
from math import exp, expm1, inf, lgamma, log, log1p


def bisected(is_above, low, high):
    """The point at which `is_above` becomes true."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        if is_above(middle):
            high = middle
        else:
            low = middle
    return high


def beta_fraction(a, b, x):
    """The continued fraction of the incomplete beta function (modified Lentz)."""
    tiny = 1e-300
    c, d = 1.0, 1.0 / max(1.0 - (a + b) * x / (a + 1.0), tiny, key=abs)
    h = d
    for m in range(1, 200000):
        for numerator in (m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                          -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))):
            d = 1.0 / (1.0 + numerator * d or tiny)
            c = 1.0 + numerator / c or tiny
            h *= c * d
        if abs(c * d - 1.0) < 1e-16:
            break
    return h


def beta_cdf(x, a, b):
    if x <= 0.0 or x >= 1.0:
        return float(x >= 1.0)
    front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log1p(-x))
    if x < (a + 1.0) / (a + b + 2.0):
        return front * beta_fraction(a, b, x) / a
    return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b


@cache
def fixed_share(k, n, risk):
    """Clopper and Pearson, both one-sided bounds at `risk`."""
    lower = 0.0 if k == 0 or n == 0 else bisected(lambda p: beta_cdf(p, k, n - k + 1) >= risk, 0.0, 1.0)
    if n == 0 or k == n:
        return lower, 1.0
    if k == 0:
        return 0.0, -expm1(log(risk) / n)
    return lower, bisected(lambda p: 1.0 - beta_cdf(p, k + 1, n - k) <= risk, 0.0, 1.0)


def log_mean(logs):
    top = max(logs)
    return top + log(sum(exp(each - top) for each in logs) / len(logs)) if top > -inf else -inf


def log_gate(k, n, limit):
    """The release gate: the mean of three likelihood ratios, q = 0, limit / 10, limit / 3."""
    clean = -n * log1p(-limit)
    logs = [clean if k == 0 else -inf]
    for part in (10.0, 3.0):
        logs.append(-k * log(part) + (n - k) * log1p(-limit / part) - (n - k) * log1p(-limit))
    return log_mean(logs)


def log_refutation(k, n, limit):
    return log_mean([k * log(c) - n * log1p((c - 1.0) * limit) for c in (2.0, 5.0, 20.0)])


@cache
def any_time_share(k, n, risk):
    goal = -log(risk)
    lower, upper = 0.0, 1.0
    if n > 0 and k < n:
        upper = bisected(lambda p: log_gate(k, n, p) >= goal, 0.0, 1.0)
    if k > 0 and log_refutation(k, n, 0.0) >= goal:
        lower = bisected(lambda p: log_refutation(k, n, p) < goal, 0.0, 1.0)
    return lower, upper


def bounds(method, unit, k, units, risk, cells=1, run_hours=0.0):
    """One-sided lower and upper bound at `risk`. If each of several cells is judged for itself (unit "run") and k is of
    the worst, the cells share the risk of the lower bound. A rate per AGV-hour follows from the share of worlds, if a run
    has `run_hours` of them."""
    share = any_time_share if method == "any-time" else fixed_share
    lower = share(k, units, risk / cells if unit == "run" and cells else risk)[0]
    upper = share(k, units, risk)[1]
    if unit != "agv-hour":
        return lower, upper
    return lower / (run_hours * cells), upper / ((1.0 - upper) * run_hours) if upper < 1.0 else inf


def largest_share(gate, run_hours):
    """The largest share of worlds that meets the limit of a gate."""
    failures = gate["limit_rate"] * run_hours
    return failures / (1.0 + failures) if gate["unit"] == "agv-hour" else gate["limit_rate"]

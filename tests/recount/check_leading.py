"""Whether the verbs lead with the failure that the rule of leading.py names: check_leading.py PROGRAM DB [SHRUNK].

Every violating run is replayed. SHRUNK of them (all, without that word) are also given to `shrink` and `explain`, with
so little to try that only what they are about is learnt. Prints each difference, and how many runs were looked at."""
import json
import sqlite3
import subprocess
import sys

from leading import failures, rows_of


def asked(program, *words):
    finished = subprocess.run([program, *words], capture_output=True, text=True, check=False)
    return json.loads(finished.stdout) if finished.stdout.startswith("{") else {"error": finished.stderr}


def number(body):
    return None if body is None or body == 2**32 - 1 else body


def differences(program, archive, run, expected, is_shrunk):
    index = str(run["run_index"])
    replayed = asked(program, "replay", archive, index, "--json").get("failures", [])
    same = [(f["what"], number(f["a"]), number(f["b"]), f["judged"]) for f in replayed]
    wanted = [(f["what"], f["a"], f["b"], f["judged"]) for f in expected]
    if same != wanted:
        yield f"run {index}: replay tells {same[:2]}, expected {wanted[:2]}"
    if not is_shrunk:
        return
    in_short = ["shrink", "-o", f"{index}.case.json", "--max-trials", "1"], ["explain", "--max-time", "3"]
    for verb in in_short:
        told = asked(program, verb[0], archive, index, "--json", *verb[1:])
        if not told.get("failure", "").startswith(expected[0]["what"]):
            yield f"run {index}: {verb[0]} tells {told.get('failure', told)}, expected {expected[0]['what']}"


def main(program, archive, shrunk=None):
    db = sqlite3.connect(f"file:{archive}?mode=ro", uri=True)
    db.row_factory = sqlite3.Row
    runs = db.execute("SELECT * FROM runs WHERE violation ORDER BY run_index").fetchall()
    different = earlier = 0
    for place, run in enumerate(runs):
        expected = failures(run, *rows_of(db, run["run_index"]))
        earlier += min(expected, key=lambda failure: failure["at"])["what"] != expected[0]["what"]
        for line in differences(program, archive, run, expected, shrunk is None or place < int(shrunk)):
            print(line)
            different += 1
    print(f"{len(runs)} violating runs, in {earlier} of which something lighter began earlier: {different} differences")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

"""The agent of bridge_cost.cpp in Python."""
import json
import sys

for text in sys.stdin:
    told = json.loads(text)
    if "hello" in told:
        said = {"hello": {"protocol": 1, "name": "ticker", "deterministic": True}}
    elif "bye" in told:
        said = {"bye": {}}
    elif "event" in told:
        ticks = told["event"] in ("start", "timer")
        said = {"calls": [["get_position"], ["set_timer", 0, told["now_ns"] + 50000000]] if ticks else []}
    else:
        continue
    sys.stdout.write(json.dumps(said) + "\n")
    sys.stdout.flush()

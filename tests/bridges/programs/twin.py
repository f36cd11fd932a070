"""The twin of the agent `twin` in lockstep_twin_test.cpp: every call of that one, in the same order."""
import json
import struct
import sys


def line():
    text = sys.stdin.readline()
    return json.loads(text) if text else None


def say(what):
    sys.stdout.write(json.dumps(what) + "\n")
    sys.stdout.flush()


def bits_of(number):
    return struct.pack(">d", number).hex()


def activation(world, at, told):
    if told["event"] == "refused":
        return say({"calls": []})
    me = told["self"]
    if told["event"] == "start":
        at[me] = told["start_station"]
    calls = [["now_ns"], ["get_position"], ["get_battery_level"], ["is_loaded"], ["get_load"]]
    said = bits_of(told["pose"][0]) + bits_of(told["battery_level"])
    for message in told["messages"]:
        calls.append(["get_message"])
        calls.append(["log", "%d %s" % (message["sender"], message["bytes"].encode("latin-1").hex())])
    calls += [["get_message"], ["describe", {"kind": "SAID", "content": "all", "asks": "7", "about": "\u00e9"}]]
    calls += [["send_broadcast", said + "\u00ff\u0000\"\\"], ["sometimes", "woke"]]
    calls += [["set_timer", 1, told["now_ns"] + 700000000], ["declare_state", "wandering"], ["get_action"]]
    calls.append(["keep", 7, said])
    if told["event"] == "order":
        calls.append(["works_on", me, told["order_id"]])
    if told["action"] == "idle":
        say({"calls": calls, "ask": ["random", 3, told["now_ns"]]})
        draw = int(line()["value"], 16)
        leaving = world["stations"][at[me]]["lanes"]
        lane = world["lanes"][leaving[draw % len(leaving)]]
        calls = [["move" if draw % 3 else "pick", lane["segment"]]]
        at[me] = lane["to"]
    return say({"calls": calls})


def main():
    world, at = None, {}
    while (told := line()) is not None:
        if "hello" in told:
            say({"hello": {"protocol": 1, "name": "twin", "deterministic": True, "faults": ["deaf"]}})
        elif "run" in told:
            world, at = told["run"]["map"], {}
        elif "bye" in told:
            say({"bye": {}})
        elif "event" in told:
            activation(world, at, told)


main()

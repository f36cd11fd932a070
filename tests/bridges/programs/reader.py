"""Says a number each second, logs what it is told, and reads one message in three seconds; `all`: all of them."""
import json
import sys


def say(what):
    sys.stdout.write(json.dumps(what) + "\n")
    sys.stdout.flush()


def activation(told, ticks):
    me, now_ns = told["self"], told["now_ns"]
    calls = [["log", "%d told %s" % (me, message["bytes"])] for message in told["messages"]]
    if told["event"] in ("start", "timer"):
        ticks[me] = ticks.get(me, 0) + 1
        calls += [["set_timer", 1, now_ns + 1000000000], ["send_broadcast", str(ticks[me])]]
        if ticks[me] % 3 == 0 and sys.argv[1:] == ["all"]:
            calls += [["get_messages"]]
        elif ticks[me] % 6 == 0:
            calls += [["get_message"], ["log", "%d read unasked" % me]]
        elif ticks[me] % 3 == 0:
            say({"calls": calls, "ask": ["get_message"]})
            answer = json.loads(sys.stdin.readline())
            calls = [["log", "%d read %s" % (me, answer.get("bytes"))]]
    say({"calls": calls})


def main():
    ticks = {}
    for text in sys.stdin:
        told = json.loads(text)
        if "hello" in told:
            say({"hello": {"protocol": 1, "name": "reader", "deterministic": True}})
        elif "bye" in told:
            say({"bye": {}})
        elif "run" in told:
            ticks = {}
        elif "event" in told:
            activation(told, ticks)


main()

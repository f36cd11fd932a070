"""A program that speaks lockstep until its third event of a participant, and then does what its argument says."""
import json
import os
import subprocess
import sys
import time


def say(what):
    sys.stdout.write(json.dumps(what) + "\n")
    sys.stdout.flush()


def written_elsewhere():
    """To how many descriptors beside the three standard ones it can write."""
    count = 0
    for number in range(3, 1000):
        try:
            count += os.write(number, b"x")
        except OSError:
            pass
    return count


def misbehave(how, told):
    if how == "no-json":
        print("starting up ...", flush=True)
    elif how == "no-object":
        say([1, 2])
    elif how == "no-calls":
        say({"call": []})
    elif how == "unknown-call":
        say({"calls": [["move"], ["fly", 3]]} if told is None else {"calls": [["fly", 3]]})
    elif how == "wrong-argument":
        say({"calls": [["move", -1]]})
    elif how == "missing-argument":
        say({"calls": [["set_timer", 1]]})
    elif how == "no-kind":
        say({"calls": [["describe", {"content": "holds C2"}]]})
    elif how == "unknown-field":
        say({"calls": [["describe", {"kind": "GRANT", "anwsers": "7"}]]})
    elif how == "no-byte":
        say({"calls": [["send_broadcast", "\u20ac"]]})
    elif how == "calls-no-list":
        say({"calls": 3})
    elif how == "unknown-ask":
        say({"ask": ["fly"]})
    elif how == "deep":
        os.write(1, b'{"calls": [' + b"[" * 1000000 + b"]" * 1000000 + b"]}\n")
    elif how == "no-utf8":
        os.write(1, b'{"calls": [["log", "\xff\xfe"]]}\n')
    elif how == "flood":
        while True:  # small enough for a pipe to take it whole
            os.write(1, b'{"calls": []}\n' * 200)
    elif how == "close-input":
        os.close(0)
        say({"calls": []})
        time.sleep(1000)
    elif how == "other-descriptors":
        say({"calls": [["log", str(written_elsewhere())]]})
    elif how == "exit":
        sys.exit(3)
    elif how == "signal":
        os.abort()
    elif how == "close":
        os.close(1)
        time.sleep(1000)
    elif how == "half-a-line":
        os.write(1, b'{"calls"')
        os._exit(0)
    elif how == "long":
        os.write(1, b'"' + b"x" * (17 << 20))
        time.sleep(1000)
    elif how == "two-lines":
        os.write(1, b'{"calls": []}\n{"calls": []}\n')
    elif how == "leave-a-child":
        subprocess.Popen(["sleep", "5"])
        os._exit(0)
    elif how == "fail":
        say({"calls": [["fail", False, "the battery is on fire"], ["move", 0]]})
    elif how == "fail-hang":
        say({"calls": [["fail", True, "it does not come back"]]})
    elif how == "silent":
        time.sleep(1000)
    elif how == "busy-child":
        subprocess.run([sys.executable, "-c", "while True: pass"], check=False)
    elif how == "memory":
        kept = bytearray(os.urandom(1 << 20)) * 150
        time.sleep(1000 + len(kept))
    elif how == "orphan":
        subprocess.Popen(["setsid", "sh", "-c", "sleep %s & sleep %s" % (sys.argv[2], sys.argv[2])])
        say({"calls": []})


def main():
    how, events, runs_served = sys.argv[1], 0, 0
    for text in sys.stdin:
        told = json.loads(text)
        if "hello" in told:
            if how == "no-hello":
                say({"calls": []})
            elif how == "other-version":
                say({"hello": {"protocol": 2, "name": "unruly"}})
            elif how == "ends-at-once":
                sys.exit(1)
            else:
                runs = "one" if how == "one-run" else "many"
                say({"hello": {"protocol": 1, "name": "unruly", "runs": runs}})
        elif "run" in told:
            runs_served += 1
        elif "bye" in told:
            if how == "no-bye":
                say({"calls": []})
            elif how == "one-run":
                return
            else:
                say({"bye": {}})
                events = 0
        elif "event" in told:
            events += 1
            if told["event"] == "refused":
                say({"calls": [["log", json.dumps(told["refused"])]]})
            elif told["event"] == "start" and how == "refused":
                say({"calls": [["move", 99], ["get_position"], ["send_unicast", "x", 77], ["move", 0]]})
            elif how == "keep-state":
                say({"calls": [["send_broadcast", "served %d" % runs_served]]})
            elif how == "talk":
                words = [["log", "word %d of event %d %s" % (word, events, "x" * 100)] for word in range(100)]
                say({"calls": words + [["set_timer", 1, told["now_ns"] + 200000000]]})
            elif how == "draw":
                say({"calls": [["send_broadcast", os.urandom(8).hex()]]})
            elif how == "pid":
                say({"calls": [["log", str(os.getpid())], ["log", " ".join(sys.argv[2:])]]})
            elif events == 3:
                misbehave(how, told)
            else:
                say({"calls": [["set_timer", 1, told["now_ns"] + 1000000000]]})


main()

"""The Python package speaks lockstep: lines that a program says, for lines that the engine says."""

import json
import math
import os
import sys
import unittest
from typing import Any, List

from scripted_engine import EXAMPLES, FOLDER, PACKAGE, Engine, message, run_line

from fleetproof.world import BACKWARD, read_world

PROGRAMS = os.path.join(FOLDER, "programs.py")


def logged(calls: List[List[Any]]) -> List[str]:
    return [call[1] for call in calls if call[0] == "log"]


class Package(unittest.TestCase):
    def started(self, *program: str, **answers: Any) -> Engine:
        engine = Engine(list(program), answers)
        self.addCleanup(engine.close)
        return engine

    def serving(self, name: str, **answers: Any) -> Engine:
        engine = self.started(PROGRAMS, name, **answers)
        engine.introduce()
        engine.run()
        return engine

    def test_it_introduces_itself(self) -> None:
        usual = self.serving("told").hello
        self.assertEqual(usual["protocol"], 1)
        self.assertEqual((usual["name"], usual["roles"], usual["runs"]), ("told", ["agv"], "many"))
        self.assertEqual((usual["deterministic"], usual["faults"]), (True, ["dirt"]))
        other = self.serving("waits").hello
        self.assertEqual((other["roles"], other["runs"]), (["agv", "computer"], "one"))
        self.assertEqual((other["deterministic"], other["description"]), (False, "waits a lot"))

    def test_it_needs_a_program(self) -> None:
        with self.assertRaisesRegex(EOFError, "give a program as vehicle="):
            self.started(PROGRAMS, "nothing").introduce()

    def test_callbacks_hear_every_event(self) -> None:
        engine = self.serving("told")
        self.assertEqual(engine.event("start", boot=2), [["log", "start 2 0"]])
        order = logged(engine.event("order", order_id=4, **{"from": 1, "to": 2}))
        self.assertEqual(order, ["Order(id=4, origin=1, destination=2)"])
        two = [message("a"), message("\u00ff", 2)]
        self.assertEqual(
            engine.event("message", messages=two),
            [
                ["get_message"],
                ["log", "Message(sender=1, data=b'a')"],
                ["get_message"],
                ["log", "Message(sender=2, data=b'\\xff')"],
                ["get_message"],
            ],
        )
        self.assertEqual(logged(engine.event("timer", 1.5, timer=3)), ["timer 3 at 1.5"])
        self.assertEqual(logged(engine.event("action_done", result="refused")), ["done refused"])
        self.assertEqual(logged(engine.event("withdrawn", order_id=4)), ["withdrawn 4"])
        fault = engine.event("fault", fault_word="dirt", fault_number=2, fault_length_ns=3)
        self.assertEqual(logged(fault), ["Fault(word='dirt', number=2, length_ns=3)"])
        refused = engine.event("refused", refused=[{"call": 0, "name": "log", "result": "invalid"}])
        self.assertEqual(logged(refused), ["log invalid"])
        self.assertEqual(engine.event("an event of a later version"), [])

    def test_a_restart_makes_a_new_object_and_bye_ends_all(self) -> None:
        engine = self.serving("told")
        engine.event("start")
        engine.tell({"destroy": 0})
        self.assertEqual(logged(engine.event("start", boot=1)), ["start 1 0"])
        self.assertEqual(engine.bye(), {"bye": {}})
        engine.run()
        self.assertEqual(logged(engine.event("start")), ["start 0 0"])
        self.assertEqual(engine.end(), (0, "end of 0\nend of 0\nend of 0\n"))

    def test_participants_end_when_the_engine_says_so(self) -> None:
        engine = self.serving("told")
        for participant in (0, 1):
            engine.event("start", self_id=participant)
        engine.tell({"destroy": 1})
        self.assertEqual(engine.event("start"), [["log", "start 0 0"]], "again, without a word of the former one")
        engine.bye()
        engine.run()
        engine.event("start", self_id=1)
        engine.tell({"destroy": 1})
        self.assertEqual(engine.end(), (0, "end of 1\nend of 0\nend of 0\nend of 1\n"))

    def test_a_way_has_the_fewest_lanes(self) -> None:
        plant = read_world(run_line()).map
        ways = [plant.way(start, goal) for start, goal in ((0, 2), (2, 0), (1, 1))]
        self.assertEqual([[lane.drive for lane in way or []] for way in ways], [[0, 1], [BACKWARD + 1, BACKWARD], []])
        island = plant._replace(stations=(*plant.stations[:2], plant.stations[2]._replace(lanes=())))
        self.assertIsNone(island.way(2, 0))

    def test_every_call_has_the_form_of_the_protocol(self) -> None:
        engine = self.serving(
            "calls",
            random={"answer": "ok", "value": "ffffffffffffffff"},
            recall=lambda ask: {"answer": "ok", "bytes": "\u00c8"} if ask[1] == 1 else {"answer": "empty"},
            conflict={"answer": "ok", "conflict": True},
            keep="refused",
            move="refused",
            get_action={"answer": "ok", "action": "driving"},
        )
        calls = engine.event("start", 1.0, load=7, action="parked", messages=[message("x")])
        occupancy = {"vehicle_type": 0, "load": "any_load", "station": 1, "heading": [1.0, 0.0]}
        self.assertEqual(
            calls,
            [
                ["send_broadcast", "\u0000\u00ff"],
                ["describe", "HI"],
                ["describe", {"kind": "HI", "content": "for q", "asks": "1.0"}],
                ["send_unicast", "", 1],
                ["set_timer", 3, 1_000_000_005],
                ["declare_cost_ns", 1_000_000],
                ["safe_mode", True],
                ["waiting_for", None],
                ["works_on", 0, 7],
                ["declare_waiting", 0, 1],
                ["sometimes", "probe"],
                ["declare_state", "state"],
                ["believe", 1, [1.0, 2.0, 0.0, 1.0], 9],
                ["get_position"],
                ["get_battery_level"],
                ["is_loaded"],
                ["get_load"],
                ["get_action"],
                ["get_message"],
                ["?", "random", 1, "ffffffffffffffff"],
                ["?", "recall", 1],
                ["?", "recall", 2],
                ["log", f"[0.0, 0.5, True, 7, 'parked'] Message(sender=1, data=b'x') {2**64 - 1} b'\\xc8' None"],
                ["?", "conflict", occupancy, {"vehicle_type": 0, "load": "any_load", "lane": 0}, 0.5],
                ["?", "keep", 1, "\u00c8"],
                ["log", "True <Result.REFUSED: 'refused'>"],
                ["?", "move", 0],
                ["?", "pick", None],
                ["?", "pick_load", 1, 7],
                ["?", "drop", None],
                ["?", "park", 1],
                ["?", "charge", None],
                ["?", "stop"],
                ["?", "go_on"],
                ["?", "get_action"],
                ["log", "[False, True, True, True, True, True, True, True] driving"],
            ],
        )
        self.assertIn("on_start prints\n", engine.end()[1])

    def test_every_activation_has_one_end(self) -> None:
        engine = self.serving("ends")
        self.assertEqual(logged(engine.event("start")), ["end"])
        messages = [message("a"), message("b")]
        self.assertEqual(logged(engine.event("message", 1.0, messages=messages)), ["message", "message", "end"])

    def test_a_conflict_is_asked_once(self) -> None:
        asked: List[Any] = []

        def conflict(call: List[Any]) -> Any:
            asked.append(call)
            return {"answer": "ok", "conflict": "lane" in call[2]}

        engine = self.serving("asks twice", conflict=conflict)
        self.assertEqual(logged(engine.event("start")), ["[False, True, False, True]"])
        self.assertEqual(len(asked), 2)

    def test_a_lane_says_where_the_nose_points(self) -> None:
        told = run_line()
        told["map"]["lanes"][0]["arcs"][0]["curvature_per_m"] = math.pi / 20.0  # a quarter to the left
        lanes = read_world(told).map.lanes
        self.assertEqual(lanes[0].start_heading, (1.0, 0.0))
        x, y = lanes[0].end_heading
        self.assertAlmostEqual(x, 0.0, 12)
        self.assertAlmostEqual(y, 1.0, 12)
        self.assertEqual((lanes[2].start_heading, lanes[2].end_heading), ((-1.0, 0.0), (-1.0, 0.0)), "tail first")

    def test_an_exception_ends_its_participant_only(self) -> None:
        engine = self.serving("wrong", move="suspended")
        failed = [["sometimes", "before"], ["fail", False, "ValueError: no map of this floor"]]
        self.assertEqual(engine.event("start", self_id=0), failed)
        self.assertEqual(engine.event("start", self_id=1), [["sometimes", "before"]])
        self.assertEqual(engine.event("timer", self_id=1, timer=2), [["?", "move", 7]], "suspended: no endless loop")
        too_long = engine.event("timer", self_id=1, timer=1)
        self.assertEqual(too_long, [["fail", False, "ValueError: a message of 1025 bytes; 1024 at most"]])
        self.assertIn("Traceback", engine.end()[1])

    def test_a_master_keeps_orders_and_ticks(self) -> None:
        engine = self.serving("master")
        tick = [["set_timer", 0, 500_000_000], ["log", "[] [0, 1] 2"]]
        self.assertEqual(engine.event("start", self_id=2), tick)
        for order in (5, 3, 4):
            engine.event("order", self_id=2, order_id=order, **{"from": 0, "to": 1})
        engine.event("withdrawn", self_id=2, order_id=3)
        engine.event("message", self_id=2, messages=[message("4")])
        self.assertEqual(logged(engine.event("timer", 0.5, self_id=2, timer=0)), ["[5] [0, 1] 2"])
        self.assertEqual(engine.event("timer", 0.6, self_id=2, timer=9), [])

    def test_straight_line_code_waits_for_what_it_names(self) -> None:
        engine = self.serving("waits")
        self.assertEqual(engine.event("start"), [["set_timer", 0, 2_000_000_000]])
        self.assertEqual(engine.event("order", 0.5, order_id=7, **{"from": 1, "to": 2}), [], "is kept")
        heard = engine.event("message", 1.0, messages=[message("a")])
        text = "Message(sender=1, data=b'a') 1.0"
        self.assertEqual(heard, [["get_message"], ["log", text], ["get_message"], ["set_timer", 0, 3_000_000_000]])
        self.assertEqual(engine.event("timer", 2.0, timer=0), [], "one of the wait before")
        self.assertEqual(engine.event("timer", 3.0, timer=0), [["log", "None 3.0"], ["?", "move", 0]])
        self.assertEqual(engine.event("message", 4.0, messages=[message("b")]), [], "is kept")
        moved = engine.event("action_done", 8.0, result="ok", messages=[message("b")])
        order = "Order(id=7, origin=1, destination=2) Message(sender=1, data=b'b') 8.0"
        self.assertEqual(moved, [["log", "move ok 8.0"], ["get_message"], ["log", order], ["?", "move", 1]])
        engine.answers["pick_load"] = "refused"
        withdrawn = engine.event("withdrawn", 9.0, order_id=7)
        self.assertEqual(withdrawn[1:2], [["?", "pick_load", None, 7]])
        self.assertEqual(logged(withdrawn), ["Kind.WITHDRAWN 7", "pick refused 9.0"])
        self.assertEqual(withdrawn[-1], ["set_timer", 0, 12_000_000_000])
        over = engine.event("timer", 12.0, timer=0)
        self.assertEqual(over, [["set_timer", 0, 12_000_000_000]], "a time that is over")
        self.assertEqual(len(logged(engine.event("timer", 12.0, timer=0))), 1)
        self.assertEqual(engine.event("start", self_id=2), [])
        self.assertEqual(
            engine.event("message", self_id=2, messages=[message("c", 0)]),
            [["get_message"], ["send_unicast", "c", 0], ["get_message"]],
        )
        engine.tell({"destroy": 0})
        self.assertEqual(engine.end(), (0, "freed 0\n"))

    def test_straight_line_code_waits_after_a_restart(self) -> None:
        engine = self.serving("restarts")
        engine.event("start", boot=1, action="driving")
        look = [["get_action"], ["set_timer", 0, 2_000_000_000]]
        self.assertEqual(engine.event("timer", 1.0, timer=0, action="driving"), look)
        self.assertEqual(engine.event("action_done", 1.4, result="ok", action="turning")[0], ["get_action"])
        ended = engine.event("action_done", 1.5, result="ok")
        self.assertEqual(ended, [["get_action"], ["set_timer", 0, 1_500_000_000]])
        self.assertEqual(logged(engine.event("timer", 1.5, timer=0)), ["rests 1.5 None"])
        self.assertEqual(engine.event("timer", 2.0, timer=0), [], "the program has ended")

    def test_actions_of_a_former_boot_are_forgotten(self) -> None:
        engine = self.serving("restarts")
        engine.event("start", boot=1, action="driving")
        engine.event("action_done", 0.5, result="ok")
        self.assertEqual(engine.event("timer", 1.0, timer=0), [["get_action"], ["set_timer", 0, 1_000_000_000]])
        self.assertEqual(logged(engine.event("timer", 1.0, timer=0)), ["rests 1.0 None"])

    def test_only_events_can_be_awaited(self) -> None:
        engine = self.serving("sleeps_elsewhere")
        [[call, hang, text]] = engine.event("start")
        self.assertEqual((call, hang), ("fail", False))
        self.assertRegex(text, "TypeError: .*awaits something that no event ends")

    def test_a_program_that_catches_its_end_is_told_of(self) -> None:
        engine = self.serving("holds_on")
        engine.event("start")
        self.assertEqual(engine.bye(), {"bye": {}})
        self.assertIn("coroutine ignored GeneratorExit", engine.end()[1])

    def test_what_is_no_protocol_ends_the_process(self) -> None:
        engine = self.serving("told")
        with self.assertRaisesRegex(EOFError, "ProtocolError: an answer to nothing"):
            engine.exchange({"answer": "ok"})
        with self.assertRaisesRegex(EOFError, "protocol 2; this package speaks 1"):
            self.started(PROGRAMS, "told").exchange({"hello": {"protocol": 2, "program": "later"}})

    def test_the_example_asks_before_it_drives(self) -> None:
        carrier = os.path.join(EXAMPLES, "carrier.py")
        engine = self.started(carrier, random={"answer": "ok", "value": "0" * 16})
        engine.introduce()
        engine.run()
        self.assertEqual(engine.event("start"), [])
        asked = engine.event("order", 1.0, order_id=3, **{"from": 1, "to": 2})
        self.assertEqual(asked, [["get_load"], ["send_broadcast", "\0\0\0\0\1\0\0\0"], ["set_timer", 0, 3_000_000_000]])
        answered = engine.event("message", 2.0, messages=[message("\1\0\0\0\1\0\0\0")])
        self.assertEqual(answered, [["get_message"], ["get_message"]], "a no; the timer is set already")
        backs_off = engine.event("timer", 3.0, timer=0)
        self.assertEqual(backs_off[0][:2], ["?", "random"])
        self.assertEqual(engine.event("timer", 4.0, timer=0)[0][0], "send_broadcast")
        self.assertEqual(engine.event("timer", 6.0, timer=0), [["?", "move", 0]])
        self.assertEqual(engine.event("action_done", 9.0, result="ok"), [["?", "pick_load", None, 3]])
        self.assertEqual(engine.event("action_done", 12.0, result="ok")[0][0], "send_broadcast")
        self.assertEqual(engine.bye(), {"bye": {}})
        self.assertEqual(engine.end(), (0, ""))

    def test_the_examples_are_short_and_load_no_foreign_code(self) -> None:
        """What Python itself maps is in its own folder, or in the folders of the system's libraries."""
        own = (os.path.realpath(sys.base_prefix), os.path.realpath(sys.prefix), "/lib", "/usr/lib")
        for name in ("carrier.py", "lane_lock.py", "depot.py", "follower.py"):
            with self.subTest(name):
                file = os.path.join(EXAMPLES, name)
                engine = self.started(file, random={"answer": "ok", "value": "0" * 16})
                engine.introduce()
                engine.run()
                engine.event("start", self_id=0)
                with open(f"/proc/{engine.process.pid}/maps", encoding="utf-8") as maps:
                    mapped = {line.split()[5] for line in maps if ".so" in line}
                self.assertTrue(mapped)
                for path in mapped:
                    self.assertTrue(os.path.realpath(path).startswith(own) and "fleetproof" not in path, path)
                with open(file, encoding="utf-8") as source:
                    self.assertLess(len(source.read().splitlines()), 400)

    def test_who_grants_although_he_asks_asks_anew(self) -> None:
        def conflict(asked: List[Any]) -> Any:
            return {"answer": "ok", "conflict": "lane" in asked[1] and "lane" in asked[2]}

        engine = self.started(os.path.join(EXAMPLES, "lane_lock.py"), conflict=conflict)
        engine.introduce()
        engine.run()
        engine.event("start")

        def said(calls: List[List[Any]]) -> List[Any]:
            return [json.loads(call[1]) for call in calls if call[0].startswith("send_")]

        def hear(at_s: float, **text: Any) -> List[List[Any]]:
            return engine.event("message", at_s, messages=[message(json.dumps(text))])

        asked = engine.event("order", 1.0, order_id=3, **{"from": 1, "to": 2})
        mine = {"ask": "0.1", "lane": 0, "since_ns": 1_000_000_000}
        self.assertEqual(said(asked), [mine])
        self.assertEqual(said(hear(2.0, ask="0.7", lane=0, since_ns=1_000_000_001)), [], "it has waited longer")
        older = hear(3.0, ask="0.8", lane=0, since_ns=999_999_999)
        self.assertEqual(said(older), [{**mine, "ask": "0.2"}, {"grant": "0.8"}])
        self.assertEqual([call for call in hear(4.0, grant="0.1") if call[0] == "?"], [], "that grant is void")
        self.assertEqual(hear(5.0, grant="0.2")[-2:], [["?", "move", 0], ["get_message"]])
        self.assertEqual(said(hear(6.0, ask="0.9", lane=0, since_ns=0)), [], "it holds the floor")
        self.assertEqual(engine.bye(), {"bye": {}})

    def starting(self, name: str) -> Engine:
        engine = self.started(os.path.join(PACKAGE, "starting", name + ".py"))
        engine.introduce()
        engine.run()
        return engine

    def test_what_one_starts_with_carries_an_order(self) -> None:
        for style in ("callbacks", "straight"):
            engine = self.starting(style)
            engine.event("start")
            steps = [engine.event("order", 1.0, order_id=3, **{"from": 1, "to": 2})[-1]]
            for load in (None, 3, 3, None):
                steps.append((engine.event("action_done", 2.0, result="ok", load=load) or [["nothing"]])[-1])
            self.assertEqual(steps[:2], [["?", "move", 0], ["?", "pick_load", None, 3]], style)
            self.assertEqual(steps[2:4], [["?", "move", 1], ["?", "drop", None]], style)
            self.assertIn(steps[4], (["nothing"], ["get_load"]), style)

    def test_the_master_one_starts_with_gives_orders(self) -> None:
        engine = self.starting("master")
        engine.event("start", self_id=2)
        engine.event("order", self_id=2, order_id=3, **{"from": 1, "to": 2})
        tick = engine.event("timer", 1.0, self_id=2, timer=0)
        trip = tick[-1]
        self.assertEqual((tick[1], trip[0], trip[2]), (["works_on", 0, 3], "send_unicast", 0))
        engine.event("start")
        engine.event("message", 2.0, messages=[message(trip[1], 2)])
        engine.event("action_done", 3.0, result="ok")
        engine.event("action_done", 4.0, result="ok", load=3)
        engine.event("action_done", 5.0, result="ok", load=3)
        said = engine.event("action_done", 6.0, result="ok")
        self.assertEqual(said[0], ["send_unicast", '{"done": 3}', 2])
        engine.event("message", 7.0, self_id=2, messages=[message('{"done": 3}', 0)])
        self.assertEqual(len(engine.event("timer", 7.0, self_id=2, timer=0)), 1)


class ItsSources(unittest.TestCase):
    def test_name_no_module_that_is_not_of_python(self) -> None:
        if not hasattr(sys, "stdlib_module_names"):
            self.skipTest("this Python has no list of its modules")
        folder = os.path.join(PACKAGE, "fleetproof")
        for name in sorted(os.listdir(folder)):
            if not name.endswith(".py"):
                continue
            with open(os.path.join(folder, name), encoding="utf-8") as source:
                text = source.read()
            self.assertLess(len(text.splitlines()), 700, name)
            for line in text.splitlines():
                self.assertLessEqual(len(line), 120, f"{name}: {line}")
                words = line.split()
                if words[:1] in (["import"], ["from"]) and not words[1].startswith("."):
                    self.assertIn(words[1].split(".")[0], {*sys.stdlib_module_names, "__future__"}, name)


if __name__ == "__main__":
    unittest.main()

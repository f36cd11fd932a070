"""lane-lock: the simplest relative of hull-lock. An AGV asks all others before it turns into a lane.

Who is asked grants, unless it holds floor that conflicts, or asks for such floor itself and has waited longer. If it
grants although it asks for such floor, all that was granted to it so far is void: it asks with a new number.

Why no two AGVs hold floor that conflicts: let both have locked, A with its number a and B with its number b. When B
granted a, it did not ask with b yet, or b would have been replaced. So b is younger than the grant of a, and that is
younger than a. In the same way a is younger than b, which cannot be. Time grants nothing and frees nothing, so lost,
late, doubled and reordered messages change nothing. After a restart, an AGV holds what it may still be driving.

It may stand still where hull-lock finds a way: it plans one lane at a time, and goes any way if nobody lets it pass.
"""

import json
from typing import Dict, List, NamedTuple, Optional, Set, Tuple

import fleetproof
from fleetproof import Agv, Callbacks, Message, Occupancy, Order, Result

ASKS_AGAIN_NS = 1_000_000_000
GOES_ANY_WAY_NS = 12_000_000_000
MARGIN_M = 0.02
AT_REST = ("idle", "parked", "charging_now")

Floor = Tuple[Occupancy, ...]


class Request(NamedTuple):
    number: str
    """Of this AGV, and never used again."""
    lane: int
    floor: Floor
    since_ns: int
    granted_by: Set[int]


class LaneLock(Callbacks[Agv]):
    def __init__(self, agv: Agv) -> None:
        super().__init__(agv)
        self.map = agv.world.map
        self.others = set(range(len(agv.world.fleet))) - {agv.id}
        self.orders: List[Order] = []
        self.request: Optional[Request] = None
        self.count = 0  # of the numbers of this boot
        self.waits_since_ns: Optional[int] = None
        self.makes_way = False
        start = agv.briefing
        self.station = start.start_station or 0
        self.held = self.floor_of_station(agv.id, self.station)
        for segment in (start.start_segment, start.next_segment):  # that a former boot has begun
            begun = [n for n in self.map.stations[self.station].lanes if segment in self.segments_of(n)]
            for lane in begun:  # two, if it may be driven forward and backward
                self.held += self.floor_of(agv.id, lane)
                self.station = self.map.lanes[lane].destination

    def segments_of(self, lane: int) -> Tuple[int, int]:
        return self.map.lanes[lane].segment, self.map.lanes[lane].drive

    # ---- floor

    def floor_of_station(self, agv: int, station: int) -> Floor:
        return (Occupancy(self.agv.world.fleet[agv].vehicle_type, station=station),)

    def floor_of(self, agv: int, lane: int) -> Floor:
        """Of turning into the lane from any heading, driving it, and standing at its end."""
        there = Occupancy(self.agv.world.fleet[agv].vehicle_type, lane=lane)
        return (there, *self.floor_of_station(agv, self.map.lanes[lane].destination))

    def conflict(self, a: Floor, b: Floor) -> bool:
        return any(self.agv.conflict(one, other, MARGIN_M) for one in a for other in b)

    # ---- what happens

    def on_start(self) -> None:
        self.on_timer(0)

    def on_order(self, order: Order) -> None:
        self.orders.append(order)
        self.go_on()

    def on_timer(self, timer: int) -> None:
        self.agv.set_timer(0, self.agv.now_ns + ASKS_AGAIN_NS)
        self.go_on()
        if self.request is not None:
            self.ask()

    def on_action_done(self, result: Result) -> None:
        if result is Result.OK:
            self.go_on()

    def on_message(self, message: Message) -> None:
        said = json.loads(message.data)
        if "ask" in said:
            self.answer(message.sender, said)
        elif self.request is not None and said["grant"] == self.request.number:
            self.request.granted_by.add(message.sender)
            if self.request.granted_by == self.others:
                self.drive()

    # ---- asking and answering

    def ask_for(self, lane: int) -> None:
        self.waits_since_ns = self.agv.now_ns if self.waits_since_ns is None else self.waits_since_ns
        self.count += 1
        name = f"{self.agv.briefing.boot}.{self.count}"
        floor = self.floor_of(self.agv.id, lane)
        self.request = Request(name, lane, floor, self.waits_since_ns, set())
        if self.others:
            self.ask()
        else:
            self.drive()

    def ask(self) -> None:
        assert self.request is not None
        asked = {"ask": self.request.number, "lane": self.request.lane, "since_ns": self.request.since_ns}
        self.agv.describe("ASK")
        self.agv.broadcast(json.dumps(asked).encode())

    def answer(self, asker: int, said: Dict[str, int]) -> None:
        floor = self.floor_of(asker, said["lane"])
        if self.conflict(floor, self.held):
            self.makes_way = not self.orders
            return  # it asks again
        if self.request is not None and self.conflict(floor, self.request.floor):
            if (self.request.since_ns, self.agv.id) < (said["since_ns"], asker):
                return
            self.ask_for(self.request.lane)
        self.agv.describe("GRANT")
        self.agv.send(json.dumps({"grant": said["ask"]}).encode(), asker)

    def drive(self) -> None:
        assert self.request is not None
        lane = self.map.lanes[self.request.lane]
        if self.agv.move(lane.drive):
            self.held += self.request.floor
            self.station = lane.destination
        self.request, self.waits_since_ns, self.makes_way = None, None, False

    # ---- work

    def go_on(self) -> None:
        """The next step of the oldest order, if the AGV is at rest."""
        if self.agv.action() not in AT_REST:
            return
        self.held = self.floor_of_station(self.agv.id, self.station)
        goal = self.station
        if self.orders:
            order, load = self.orders[0], self.agv.load()
            goal = order.destination if load == order.id else order.origin
            if self.station == goal and load != order.id:
                self.agv.pick(None, order.id)
                return
            if self.station == goal:
                self.agv.drop()
                del self.orders[0]
                return
        lane = self.next_lane(goal)
        if lane is not None and (self.request is None or self.request.lane != lane):
            self.ask_for(lane)

    def next_lane(self, goal: int) -> Optional[int]:
        """Towards the goal; any lane in each second period of waiting, and to make way."""
        way = self.map.way(self.station, goal)
        waits_ns = self.agv.now_ns - (self.agv.now_ns if self.waits_since_ns is None else self.waits_since_ns)
        period = waits_ns // GOES_ANY_WAY_NS
        lanes = self.map.stations[self.station].lanes
        if way and period % 2 == 0:
            return next(lane for lane in lanes if self.map.lanes[lane] is way[0])
        if not lanes or not (way or self.makes_way):
            return None
        since_ns = self.waits_since_ns if self.waits_since_ns is not None else self.agv.now_ns
        return lanes[self.agv.random(0, since_ns + period) % len(lanes)]


if __name__ == "__main__":
    fleetproof.serve("lane-lock", vehicle=LaneLock, description="asks all others before each lane")

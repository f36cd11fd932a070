"""A central fleet in one source, in Python: the twin of depot.cpp, with the same calls in the same order.

The server hears the open orders and lets one AGV drive at a time, by a way on which it meets no AGV that stands. The
right to drive is a token: a TRIP gives it, and the STATE of an AGV that rests again gives it back. With the parameter
"impatient", a FAULT, the server gives the token to another AGV after 3 s of silence.
"""

import struct
from typing import Dict, List, NamedTuple, Optional, Tuple

import fleetproof
from fleetproof import Kind, Occupancy, Order, StraightAgv, StraightComputer

TICK_NS, PATIENCE_NS = 1_000_000_000, 3_000_000_000
LANES_MAX = 200
NONE = 0xFFFFFFFF
"""In a message: no order, no load, nothing to do at the end of a trip."""
PICK, DROP = 1, 2


class Trip(NamedTuple):
    """It names the boots of server (from 1) and AGV: what was said to or by a former self has no effect."""

    server: int = 0
    agv_boot: int = 0
    number: int = 0
    at_end: int = NONE
    """PICK, DROP or NONE."""
    order: int = NONE
    lanes: Tuple[int, ...] = ()

    def pack(self) -> bytes:
        return struct.pack(f"<6I{LANES_MAX}I", *self[:5], len(self.lanes), *self.lanes, *self.free_places())

    def free_places(self) -> List[int]:
        return [0] * (LANES_MAX - len(self.lanes))

    @staticmethod
    def unpack(data: bytes) -> "Trip":
        """A message of another size has no content."""
        if len(data) != 4 * (6 + LANES_MAX):
            return Trip()
        server, agv_boot, number, at_end, order, count, *lanes = struct.unpack(f"<6I{LANES_MAX}I", data)
        return Trip(server, agv_boot, number, at_end, order, tuple(lanes[:count]))

    def text(self, repeated: str = "") -> str:
        """For people who look at a trace: what stands before ": " is the kind of the message."""
        end = {PICK: ", pick", DROP: ", drop"}.get(self.at_end, "")
        return f"TRIP: {repeated}{len(self.lanes)} lanes{end}"


class State(NamedTuple):
    """An AGV says this only while it rests: each second, and as its answer to each message.

    So STATEs with equal numbers say the same, however late they come.
    """

    server: int = 0
    agv_boot: int = 0
    done: int = 0
    """The trip that ended last."""
    station: int = 0
    load: int = NONE

    def pack(self) -> bytes:
        return struct.pack("<5I", *self)

    @staticmethod
    def unpack(data: bytes) -> "State":
        return State(*struct.unpack("<5I", data)) if len(data) == 20 else State()


class Vehicle:
    """The program of an AGV."""

    def __init__(self, agv: StraightAgv) -> None:
        self.agv, self.map = agv, agv.world.map
        self.server_id = len(agv.world.fleet)
        self.server = self.done = 0
        self.station = self.find_out_where()

    def find_out_where(self) -> int:
        start = self.agv.briefing
        station = start.start_station or 0
        for lane in self.map.lanes:  # a former self may have begun to drive to the end of this one
            if start.start_segment in (lane.segment, lane.drive) and lane.origin == start.start_station:
                station = lane.destination
        return station

    async def run(self) -> None:
        while True:
            # At first, an action of its former self may be under way. After a contact, it waits for ever.
            await self.agv.wait_until_rest()
            trip = await self.wait_for_trip()
            await self.drive(trip)
            self.done = trip.number

    async def wait_for_trip(self) -> Trip:
        """What came before it rested counts as lost: whatever is still true is said again."""
        while self.agv.get_message() is not None:
            continue
        while True:
            self.say_state()
            message = await self.agv.message(timeout_s=1.0)
            if message is not None and self.is_new(heard := Trip.unpack(message.data)):
                return heard

    def say_state(self) -> None:
        load = self.agv.load()
        state = State(self.server, self.agv.briefing.boot, self.done, self.station, NONE if load is None else load)
        self.agv.describe("STATE")
        self.agv.send(state.pack(), self.server_id)

    def is_new(self, heard: Trip) -> bool:
        if heard.server > self.server:
            self.server, self.done = heard.server, 0
        is_for_it = (heard.server, heard.agv_boot) == (self.server, self.agv.briefing.boot)
        return is_for_it and heard.number > self.done

    async def drive(self, trip: Trip) -> None:
        """A step that is refused ends the trip."""
        for number in trip.lanes:
            lane = self.map.lanes[number]
            if not await self.agv.move(lane.drive):
                return
            self.station = lane.destination
        if trip.at_end == PICK:
            await self.agv.pick(None, trip.order)
        if trip.at_end == DROP:
            await self.agv.drop()


class Server:
    def __init__(self, computer: StraightComputer) -> None:
        self.computer, self.map = computer, computer.world.map
        self.fleet = [State() for _ in computer.world.fleet]
        """Where each AGV rested last; ``server`` 0: it has not answered this server."""
        self.stood_at: List[int] = []  # the stations of the AGVs for which `ways` holds
        self.ways: List[Dict[int, int]] = []  # by AGV and station: the last lane of its way to there
        self.orders: List[Order] = []  # oldest first
        self.trip = Trip(server=computer.briefing.boot + 1)  # the last one
        self.driver: Optional[int] = None  # who has the token
        self.given_up: Optional[int] = None  # from whom an impatient server has taken it
        self.given_at_ns = 0

    async def run(self) -> None:
        again_ns = self.computer.now_ns + TICK_NS
        while True:
            event = await self.computer.wait(Kind.ORDER | Kind.MESSAGE, until_ns=again_ns)
            now_ns = self.computer.now_ns
            if event.order is not None:
                self.orders.append(event.order)
            if event.message is not None:
                self.hear(event.message.sender, State.unpack(event.message.data))
            if self.computer.briefing.config == "impatient" and now_ns - self.given_at_ns > PATIENCE_NS:
                self.give_up()
            if now_ns >= again_ns:
                again_ns = now_ns + TICK_NS
                if self.driver is not None:
                    self.send(self.trip, self.driver, self.trip.text("again, "))
            if self.driver is None:
                self.plan()

    def send(self, trip: Trip, agv: int, kind: str) -> None:
        self.computer.describe(kind)
        self.computer.send(trip.pack(), agv)

    def hear(self, agv: int, said: State) -> None:
        if said.server != self.trip.server:
            # A TRIP without a number: it tells the AGV of this boot of the server.
            return self.send(Trip(server=self.trip.server), agv, "HELLO")
        known, trip, is_driver = self.fleet[agv], self.trip, agv == self.driver
        has_ended, has_restarted = said.done == trip.number, said.agv_boot > trip.agv_boot
        is_old = (said.agv_boot, said.done) < (known.agv_boot, known.done)
        if is_old or (is_driver and not has_ended and not has_restarted):
            return
        if is_driver and has_restarted:
            self.computer.sometimes("driver-restarted")
        if is_driver and has_ended and trip.at_end == PICK and said.load == NONE:
            self.forget(trip.order)
        if known.load != NONE and said.load == NONE:
            self.forget(known.load)
        if is_driver:
            self.driver = None
        if agv == self.given_up:
            self.given_up = None
        self.fleet[agv] = said

    def forget(self, order_id: int) -> None:
        self.orders = [order for order in self.orders if order.id != order_id]

    def give_up(self) -> None:
        if self.driver is not None:
            self.given_up, self.driver = self.driver, None

    def plan(self) -> None:
        """The oldest order that can be carried out goes first.

        If the AGVs are in each other's way, one drives a lane away.
        """
        if not self.orders or any(known.server == 0 for known in self.fleet):
            return
        self.find_ways()
        if any(self.carry_out(order) for order in self.orders):
            return
        agv = self.random(0) % len(self.fleet)
        station = self.fleet[agv].station
        away = [number for _, number in sorted(self.ways[agv].items()) if self.map.lanes[number].origin == station]
        if away:
            self.give_token(agv, [away[self.random(1) % len(away)]], NONE, NONE)

    def random(self, purpose: int) -> int:
        return self.computer.random(purpose, self.computer.now_ns)

    def carry_out(self, order: Order) -> bool:
        is_on_board = any(known.load == order.id for known in self.fleet)
        best: Optional[Tuple[int, List[int]]] = None
        for agv, known in enumerate(self.fleet):
            if agv == self.given_up or known.load != (order.id if is_on_board else NONE):
                continue
            way = self.find_way(agv, order.destination if is_on_board else order.origin)
            if way is not None and (best is None or len(way) < len(best[1])):
                best = agv, way
        if best is not None:
            self.give_token(*best, DROP if is_on_board else PICK, order.id)
        return best is not None

    def give_token(self, agv: int, way: List[int], at_end: int, order: int) -> None:
        if len(way) > LANES_MAX:  # the next trip goes on from there
            at_end = NONE
        last, boot = self.trip, self.fleet[agv].agv_boot
        self.trip = Trip(last.server, boot, last.number + 1, at_end, order, tuple(way[:LANES_MAX]))
        self.driver, self.given_at_ns = agv, self.computer.now_ns
        self.computer.works_on(agv, None if order == NONE else order)
        self.send(self.trip, agv, self.trip.text())

    def free_lanes(self, agv: int) -> List[int]:
        """On these the AGV keeps the safety distance from every AGV that stands, whatever their headings and loads."""
        types = [vehicle.vehicle_type for vehicle in self.computer.world.fleet]
        standing = [
            Occupancy(types[other], station=known.station) for other, known in enumerate(self.fleet) if other != agv
        ]
        driving = [Occupancy(types[agv], lane=number) for number in range(len(self.map.lanes))]
        meets = self.computer.conflict
        return [lane for lane, drive in enumerate(driving) if not any(meets(drive, at) for at in standing)]

    def find_ways(self) -> None:
        """The answers change only when an AGV stands elsewhere."""
        stations = [known.station for known in self.fleet]
        if stations != self.stood_at:
            self.stood_at = stations
            self.ways = [self.ways_of(agv) for agv in range(len(self.fleet))]

    def ways_of(self, agv: int) -> Dict[int, int]:
        """By the fewest lanes."""
        free = self.free_lanes(agv)
        last: Dict[int, int] = {}
        reached = [self.fleet[agv].station]
        for station in reached:
            for number in free:
                lane = self.map.lanes[number]
                if lane.origin == station and lane.destination not in last and lane.destination != reached[0]:
                    last[lane.destination] = number
                    reached.append(lane.destination)
        return last

    def find_way(self, agv: int, goal: int) -> Optional[List[int]]:
        """None: there is no way."""
        way: List[int] = []
        at = goal
        while at != self.fleet[agv].station:
            if at not in self.ways[agv]:
                return None
            way.append(self.ways[agv][at])
            at = self.map.lanes[way[-1]].origin
        return way[::-1]


async def drive_for_server(agv: StraightAgv) -> None:
    await Vehicle(agv).run()


async def serve_fleet(computer: StraightComputer) -> None:
    await Server(computer).run()


if __name__ == "__main__":
    fleetproof.serve(
        "depot", vehicle=drive_for_server, computer=serve_fleet, description="a server lets one AGV drive at a time"
    )

"""follower: the vehicle of a fleet with a `zone-server`. It carries out the steps that the server grants, one after the
other, and stands where they end. It tells the server what it has done, and its orders.

It is the built-in `follower` in Python: same messages, same calls, same trace. core/agents/central says what it
promises, and why that is enough for no two AGVs to meet.
"""

import enum
import math
import struct
from collections import deque
from typing import Deque, List, NamedTuple, Optional, Tuple

import fleetproof
from fleetproof import Agv, Callbacks, Lane, Message, Order, Result

NONE = 0xFFFFFFFF  # on the wire: no order
PULSE_S, PULSE_TIMER, PULSE_DRAWS = 0.5, 1, 1
SECOND_NS = 1_000_000_000
WRONG_CLOCK = 1.02  # clocks may run wrong by up to 1 %
TOLERANCE_M = 0.02
COSINE_OF_SAME_HEADING = 1.0 - 1e-6
LANES_MAX = 64
ORDERS_IN_A_MESSAGE = 48
AT_REST = ("idle", "parked", "charging_now")


class Kind(enum.IntEnum):
    """A step is one controller call: drives a lane, or picks, drops or charges where the AGV then stands."""

    DRIVE = 0
    PICK = 1
    DROP = 2
    CHARGE = 3


ACTIVITIES = ("driving", "picking", "dropping", "connecting to a charger")  # by kind


class Step(NamedTuple):
    kind: Kind
    what: int
    """The lane to drive; the order to pick or to drop."""


class Grant(NamedTuple):
    server_boot: int
    agv_boot: int
    first: int
    """The number of the first of these steps, from the beginning of the way."""
    steps: List[Step]
    orders: int
    """The server has so many orders of this way."""
    has_work: bool
    """An open order is for this AGV."""


def read_grant(data: bytes) -> Optional[Grant]:
    """None: the bytes are no GRANT."""
    head, step, tail = struct.Struct("<BIIII"), struct.Struct("<BI"), struct.Struct("<I?")
    if len(data) < head.size:
        return None
    mark, server_boot, agv_boot, first, count = head.unpack_from(data)
    if mark != 0xB2 or len(data) != head.size + count * step.size + tail.size:
        return None
    told = list(step.iter_unpack(data[head.size : len(data) - tail.size]))
    if any(kind > Kind.CHARGE for kind, _ in told):
        return None
    orders, has_work = tail.unpack_from(data, len(data) - tail.size)
    return Grant(server_boot, agv_boot, first, [Step(Kind(kind), what) for kind, what in told], orders, has_work)


class Phase(enum.Enum):
    LOST = enum.auto()
    """Since a restart it does not know its place, or actions of its former self are under way."""
    ENDING = enum.auto()
    """It has heard of another boot of the server, and finishes what is under way."""
    ON_WAY = enum.auto()


class OwnOrder:
    def __init__(self, order: Order, on_board: bool) -> None:
        self.order = order
        self.on_board = on_board  # when it came: after a restart
        self.done = False


class Held:
    """From where the AGV stands or drives, as far as it has steps."""

    def __init__(self, station: int) -> None:
        self.station = station
        self.heading = (1.0, 0.0)
        self.lanes: List[Lane] = []

    @property
    def end(self) -> int:
        return self.lanes[-1].destination if self.lanes else self.station

    def pass_first_lane(self) -> None:
        passed = self.lanes.pop(0)
        self.station, self.heading = passed.destination, passed.end_heading


class Follower(Callbacks[Agv]):
    def __init__(self, agv: Agv) -> None:
        super().__init__(agv)
        self.map, self.server = agv.world.map, len(agv.world.fleet)
        words = dict(word.split("=", 1) for word in agv.briefing.config.split() if "=" in word)
        self.position_error_m = float(words.get("position_error_m", 0.05))
        self.position_late_s = float(words.get("position_late_s", 1.0))
        self.phase = Phase.LOST
        self.seen_idle = False  # LOST: at the last look, and no action has ended since
        self.rests_from_ns = 0  # LOST: then a position shows how it stands
        self.draws = agv.briefing.boot << 32
        self.state = ""
        # Of its way, as its messages tell it.
        self.server_boot, self.agv_boot = 0, agv.briefing.boot
        self.stands, self.station, self.heading = False, 0, (1.0, 0.0)  # where the way began
        self.load_then = NONE
        self.known = self.done = self.number = 0
        self.has_work = False
        self.orders: List[OwnOrder] = []
        self.orders_told = 0  # the server has so many of them
        self.steps: Deque[Step] = deque()  # that are not done
        self.under_way = 0  # of these: the first one, and perhaps the move that has been given to follow it
        # Its former self has begun these segments. What else it was granted, it does not know and does not use.
        self.held = Held(agv.briefing.start_station or 0)
        for segment in (agv.briefing.start_segment, agv.briefing.next_segment):
            leaving = (self.map.lanes[number] for number in self.map.stations[self.held.end].lanes)
            self.held.lanes += [lane for lane in leaving if lane.drive == segment][:1]
        while self.held.lanes:
            self.held.pass_first_lane()

    # ---- what happens

    def on_start(self) -> None:
        self.await_new_positions(SECOND_NS)
        if self.agv_boot > 0:
            self.agv.sometimes("restarted")
        else:
            pose = self.agv.position()
            self.held.heading = (pose.heading_x, pose.heading_y)
            self.begin_way()
        self.tick()

    def on_timer(self, timer: int) -> None:
        self.tick()

    def on_order(self, order: Order) -> None:
        self.orders.append(OwnOrder(order, self.load() == order.id))

    def on_message(self, message: Message) -> None:
        if message.sender == self.server:
            self.obey(message.data)

    def on_action_done(self, result: Result) -> None:
        """After a refusal the AGV is out of order where it is, for good: this step never ends."""
        self.seen_idle = False
        if self.under_way == 0 or result is not Result.OK:
            return
        self.under_way -= 1
        self.finish_step()
        if self.phase is Phase.ENDING and self.under_way == 0:
            self.begin_way()
        self.act()
        self.report()

    def on_activation_end(self) -> None:
        self.act()
        state = self.activity()
        if state != self.state:
            self.state = state
            self.agv.declare_state(state)

    def tick(self) -> None:
        draw = self.agv.random(PULSE_DRAWS, self.draws)
        self.draws += 1
        pause_s = PULSE_S * (0.8 + 0.4 * ((draw >> 11) * 2.0**-53))
        self.agv.set_timer(PULSE_TIMER, self.agv.now_ns + int(pause_s * 1e9))
        if self.phase is Phase.LOST:
            self.find_place()
        self.report()

    # ---- its place, and the beginning of a way

    def await_new_positions(self, more_ns: int) -> None:
        """No position that it perceives after this is older than now."""
        self.rests_from_ns = self.agv.now_ns + int(WRONG_CLOCK * self.position_late_s * 1e9) + more_ns

    def find_place(self) -> None:
        """If the AGV was idle at two looks, and no action ended between them, nothing of its former self is under way.
        When no position can be older than its last motion, the heading is right."""
        idle = self.agv.action() in AT_REST
        was_idle, self.seen_idle = self.seen_idle, idle
        if not idle:
            self.await_new_positions(0)
        if not idle or not was_idle or self.agv.now_ns <= self.rests_from_ns:
            return
        pose, station = self.agv.position(), self.map.stations[self.held.station]
        x_m, y_m = pose.x_m - station.x_m, pose.y_m - station.y_m
        if math.sqrt(x_m * x_m + y_m * y_m) > 2.0 * self.position_error_m + TOLERANCE_M:
            return  # a contact has stopped it beside the station
        self.held.heading = (pose.heading_x, pose.heading_y)
        self.begin_way()

    def begin_way(self) -> None:
        """Requires: the AGV rests, and the held path says where."""
        self.phase, self.stands = Phase.ON_WAY, True
        self.station, self.heading = self.held.station, self.held.heading
        self.known = self.done = 0
        self.load_then = self.load()
        # Its former self may have put down a load that was still on board when the orders came.
        self.orders = [
            own
            for own in self.orders
            if not own.done and not (own.on_board and own.order.id != self.load_then)
        ]
        self.orders_told = 0

    # ---- what it is granted

    def obey(self, data: bytes) -> None:
        grant = read_grant(data)
        if grant is None:
            return
        if grant.server_boot > self.server_boot:
            self.follow_boot(grant.server_boot)
        is_of_this_way = (grant.server_boot, grant.agv_boot) == (self.server_boot, self.agv_boot)
        if self.phase is not Phase.ON_WAY or not is_of_this_way:
            self.agv.sometimes("grant-of-another-way")
            return
        self.has_work = grant.has_work
        self.orders_told = max(self.orders_told, min(grant.orders, len(self.orders)))
        self.take_steps(grant)

    def follow_boot(self, server_boot: int) -> None:
        """It forgets the steps of the former boot, but for those under way: at their end a new way begins."""
        self.agv.sometimes("server-restarted")
        self.server_boot = server_boot
        if self.phase is Phase.LOST:
            return
        self.steps = deque(list(self.steps)[: self.under_way])
        del self.held.lanes[sum(step.kind is Kind.DRIVE for step in self.steps) :]
        self.phase, self.stands = Phase.ENDING, False
        if self.under_way == 0:
            self.begin_way()

    def take_steps(self, grant: Grant) -> None:
        """The first steps may be known already. If others are missing before them, it waits for these."""
        if grant.first > self.known:
            self.agv.sometimes("grant-lost")
        if grant.first > self.known or grant.first + len(grant.steps) <= self.known:
            return
        for step in grant.steps[self.known - grant.first :]:
            if step.kind is Kind.DRIVE:
                fits = step.what < len(self.map.lanes) and len(self.held.lanes) < LANES_MAX
                if not fits or self.map.lanes[step.what].origin != self.held.end:
                    break
                self.held.lanes.append(self.map.lanes[step.what])
            self.steps.append(step)
            self.known += 1
        self.act()
        self.report()

    # ---- what it does

    def act(self) -> None:
        while self.phase is Phase.ON_WAY and self.under_way == 0 and self.steps:
            step = self.steps[0]
            if not self.is_needless(step):
                if self.begin(step):
                    self.under_way = 1
                    break
                if step.kind is not Kind.PICK or self.agv.action() not in AT_REST:
                    return
                self.finish_order(step.what)  # its load is not here
            self.finish_step()
        self.roll_on()

    def begin(self, step: Step) -> Result:
        if step.kind is Kind.DRIVE:
            return self.agv.move(self.map.lanes[step.what].drive)
        if step.kind is Kind.PICK:
            return self.agv.pick(None, step.what)
        return self.agv.charge() if step.kind is Kind.CHARGE else self.agv.drop()

    def is_needless(self, step: Step) -> bool:
        """What its former self did already, or what a load that was not there has made pointless."""
        if step.kind is Kind.PICK:
            return self.load() == step.what
        return step.kind is Kind.DROP and self.load() != step.what

    def roll_on(self) -> None:
        """If the move is given before the AGV brakes, the AGV does not stop between two lanes."""
        if self.phase is not Phase.ON_WAY or self.under_way != 1 or len(self.steps) < 2:
            return
        if any(step.kind is not Kind.DRIVE for step in (self.steps[0], self.steps[1])):
            return
        at_end = self.map.lanes[self.steps[0].what].end_heading
        following = self.map.lanes[self.steps[1].what]
        cosine = at_end[0] * following.start_heading[0] + at_end[1] * following.start_heading[1]
        if cosine > COSINE_OF_SAME_HEADING and self.agv.move(following.drive):
            self.under_way = 2

    def finish_step(self) -> None:
        step = self.steps.popleft()
        self.done += 1
        if step.kind is Kind.DRIVE:
            self.held.pass_first_lane()
        if step.kind is Kind.DROP:
            self.finish_order(step.what)

    def finish_order(self, order: int) -> None:
        for own in self.orders:
            own.done = own.done or own.order.id == order

    # ---- what it says

    def load(self) -> int:
        load = self.agv.load()
        return NONE if load is None else load

    def report(self) -> None:
        self.number += 1
        battery, out_of_order = self.agv.battery_level(), self.agv.action() == "out_of_order"
        orders: List[Tuple[int, int, int]] = [tuple(own.order) for own in self.orders[self.orders_told :]]
        del orders[ORDERS_IN_A_MESSAGE:]
        self.agv.describe(f"STATE: {self.done} of {self.known} steps")
        state = struct.pack("<BII?Idd", 0xB1, self.server_boot, self.agv_boot, self.stands, self.station, *self.heading)
        state += struct.pack("<IIII", self.load_then, self.known, self.done, self.number)
        state += struct.pack("<d??II", battery, out_of_order, self.has_work, self.orders_told, len(orders))
        self.agv.send(state + b"".join(struct.pack("<III", *order) for order in orders), self.server)

    def activity(self) -> str:
        if self.phase is Phase.LOST:
            return "finding its place"
        if self.under_way > 0:
            return ACTIVITIES[self.steps[0].kind]
        has_orders = bool(self.orders) and not self.orders[-1].done
        return "waiting" if has_orders or self.has_work or self.load() != NONE else "idle"


if __name__ == "__main__":
    fleetproof.serve("follower-in-python", vehicle=Follower, description="drives as its zone-server grants")

"""What carrier.cpp does, in Python: a vehicle that carries its own orders, as straight-line code.

It asks all others before it drives to a station, and answers "no" for its own station and the one to which it drives.
FAULT: it takes two seconds of silence for consent. A lost or late "no" is silence, too.
"""

import struct
from typing import List, Optional

import fleetproof
from fleetproof import Kind, Message, Order, Result, StraightAgv

MAY_I, NO = 0, 1


class Carrier:
    def __init__(self, agv: StraightAgv) -> None:
        self.agv, self.map = agv, agv.world.map
        self.here, self.goal, self.heard_no = agv.briefing.start_station or 0, -1, False

    async def run(self) -> None:
        if self.agv.briefing.boot > 0:
            await self.find_out_where()
        while True:
            event = await self.agv.wait(Kind.ORDER | Kind.MESSAGE)
            if event.message is not None:
                self.hear(event.message)
            if event.order is not None:
                await self.carry(event.order)

    async def find_out_where(self) -> None:
        """The former boot may have driven on from the start station."""
        start = self.agv.briefing
        for lane in self.map.lanes:
            if start.start_segment in (lane.segment, lane.drive) and lane.origin == start.start_station:
                self.here = lane.destination
        await self.agv.wait_until_rest()

    async def carry(self, order: Order) -> None:
        if self.agv.load() != order.id:
            if not await self.drive_to(order.origin) or not await self.agv.pick(None, order.id):
                return
        if await self.drive_to(order.destination):
            await self.agv.drop()

    async def drive_to(self, goal: int) -> bool:
        """By the fewest lanes, searched from the end."""
        next_lane: List[Optional[int]] = [None] * len(self.map.stations)
        reached = [goal]
        for station in reached:
            for number, lane in enumerate(self.map.lanes):
                if lane.destination == station and lane.origin != goal and next_lane[lane.origin] is None:
                    next_lane[lane.origin] = number
                    reached.append(lane.origin)
        while self.here != goal:
            number = next_lane[self.here]
            if number is None or not await self.drive(number):
                return False
        return True

    async def drive(self, number: int) -> bool:
        lane = self.map.lanes[number]
        self.goal = lane.destination
        while not await self.everybody_is_silent():
            await self.listen(1_000_000_000 + self.agv.random(0, self.agv.now_ns) % 1_000_000_000)
        if not self.agv.begin("move", lane.drive):
            return False
        while (event := await self.agv.wait(Kind.MESSAGE | Kind.DONE)).message is not None:
            self.hear(event.message)
        if event.result is Result.OK:
            self.here = self.goal
        return event.result is Result.OK

    async def everybody_is_silent(self) -> bool:
        self.heard_no = False
        self.agv.broadcast(struct.pack("<II", MAY_I, self.goal))
        await self.listen(2_000_000_000)
        return not self.heard_no

    async def listen(self, duration_ns: int) -> None:
        until_ns = self.agv.now_ns + duration_ns
        while (message := await self.agv.message(until_ns=until_ns)) is not None:
            self.hear(message)

    def hear(self, message: Message) -> None:
        if len(message.data) != 8:
            return
        what, station = struct.unpack("<II", message.data)
        if what == NO and station == self.goal:
            self.heard_no = True
        if what == MAY_I and station in (self.here, self.goal):
            self.agv.send(struct.pack("<II", NO, station), message.sender)


async def carrier(agv: StraightAgv) -> None:
    await Carrier(agv).run()


if __name__ == "__main__":
    fleetproof.serve("carrier", vehicle=carrier, description="takes silence for consent")

"""my-agent: the software on board of an AGV, in callbacks. It carries out its transports, and asks nobody.

Try it: name it in a campaign as { name = "my-agent", run = "python3 agent.py", way = "lockstep" }.
"""

from typing import List

import fleetproof
from fleetproof import Agv, Callbacks, Order, Result


class MyAgent(Callbacks[Agv]):
    def __init__(self, agv: Agv) -> None:
        super().__init__(agv)
        self.station = agv.briefing.start_station or 0
        self.goal = self.station  # of the drive under way
        self.orders: List[Order] = []

    def on_start(self) -> None:
        # After a restart: an action of the former boot may be under way, to the end of start_segment.
        for lane in self.agv.world.map.lanes:
            if self.agv.briefing.start_segment in (lane.segment, lane.drive) and lane.origin == self.station:
                self.station = self.goal = lane.destination
        self.go_on()

    def on_order(self, order: Order) -> None:
        self.orders.append(order)
        self.go_on()

    def on_action_done(self, result: Result) -> None:
        if result is Result.OK:
            self.station = self.goal
        self.go_on()

    def go_on(self) -> None:
        """The next step of the oldest order, if the AGV is idle."""
        if not self.orders or self.agv.action() != "idle":
            return
        order, load = self.orders[0], self.agv.load()
        target = order.destination if load == order.id else order.origin
        if self.station != target:
            way = self.agv.world.map.way(self.station, target)
            if way is not None and self.agv.move(way[0].drive):
                self.goal = way[0].destination
        elif load != order.id:
            self.agv.pick(None, order.id)
        elif self.agv.drop():
            del self.orders[0]


if __name__ == "__main__":
    fleetproof.serve("my-agent", vehicle=MyAgent)

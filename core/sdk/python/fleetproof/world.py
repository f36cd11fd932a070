"""What a program is told: the world of a run, and what stands in events. Plain data, read from lines."""

from __future__ import annotations

import math
from typing import Any, Dict, List, NamedTuple, Optional, Tuple

BACKWARD = 0x80000000
"""Added to the segment of an action: the AGV drives it tail first (``Lane.drive`` has it added where it is needed)."""

MESSAGE_BYTES_MAX = 1024


class Pose(NamedTuple):
    """Where a reference point is, in metres, with the heading as a unit vector."""

    x_m: float
    y_m: float
    heading_x: float
    heading_y: float


class Order(NamedTuple):
    """A transport: its load waits at station ``origin`` and has to be brought to station ``destination``."""

    id: int
    origin: int
    destination: int


class Message(NamedTuple):
    sender: int
    data: bytes


class Fault(NamedTuple):
    """A fault that only the program understands. It begins at the event and lasts ``length_ns``."""

    word: str
    number: int
    length_ns: int


class Station(NamedTuple):
    name: str
    x_m: float
    y_m: float
    purposes: Tuple[str, ...]
    """Of "routing", "storage", "charging", "parking"."""
    lanes: Tuple[int, ...]
    """The numbers of the lanes that leave this station."""
    turning_forbidden: bool
    heading: Optional[Tuple[float, float]]
    """That an AGV must have to pick, drop, park or charge here; None: any."""


def _turned(heading: Tuple[float, float], angle_rad: float) -> Tuple[float, float]:
    """The heading turned left. By polynomials: sines of ``math`` differ between processors."""
    steps = math.ceil(abs(angle_rad) / 0.25)
    if steps < 1:
        return heading
    a = angle_rad / steps
    q = a * a
    sine = a * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0 * (1.0 - q / 110.0)))))
    cosine = 1.0 - q / 2.0 * (
        1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0 * (1.0 - q / 132.0))))
    )
    x, y = heading
    for _ in range(steps):
        x, y = cosine * x - sine * y, sine * x + cosine * y
    return x, y


class Arc(NamedTuple):
    """A straight line (curvature 0) or a circular arc (a positive curvature turns left) from ``start`` on."""

    start: Pose
    length_m: float
    curvature_per_m: float

    @property
    def end_heading(self) -> Tuple[float, float]:
        """Of the way, at the end."""
        heading = (self.start.heading_x, self.start.heading_y)
        angle_rad = self.curvature_per_m * self.length_m
        return heading if abs(angle_rad) < 1e-9 else _turned(heading, angle_rad)


class Lane(NamedTuple):
    """One way to drive a segment: in one direction, forward or backward."""

    segment: int
    origin: int
    """The station at which it begins."""
    destination: int
    """The station at which it ends."""
    length_m: float
    arcs: Tuple[Arc, ...]
    speed_limit_mps: float
    """0: no limit but the vehicle's own."""
    width_m: float
    """Of the floor drawn for this lane; 0: not known."""
    blocks: Tuple[int, ...]
    backward: bool
    permissions: Tuple[Tuple[Optional[int], str], ...]
    """Vehicle type (None: every type) and "any_load", "empty_only" or "loaded_only"; none: every AGV may drive here."""

    @property
    def drive(self) -> int:
        """The segment as an action takes it."""
        return self.segment + BACKWARD if self.backward else self.segment

    @property
    def start_heading(self) -> Tuple[float, float]:
        """Where the nose of an AGV points when it begins to drive the lane."""
        return self._of_nose((self.arcs[0].start.heading_x, self.arcs[0].start.heading_y))

    @property
    def end_heading(self) -> Tuple[float, float]:
        """Where the nose points at the end of the lane."""
        return self._of_nose(self.arcs[-1].end_heading)

    def _of_nose(self, heading: Tuple[float, float]) -> Tuple[float, float]:
        nose = -1.0 if self.backward else 1.0
        return nose * heading[0], nose * heading[1]


class Block(NamedTuple):
    name: str
    kind: str
    """ "one_vehicle" or "same_direction"."""


class Map(NamedTuple):
    stations: Tuple[Station, ...]
    lanes: Tuple[Lane, ...]
    blocks: Tuple[Block, ...]

    def way(self, start: int, goal: int) -> Optional[List[Lane]]:
        """The lanes from a station to another, as few as possible; None: there is no way.

        It knows nothing of permissions, other AGVs and lengths: a way to begin with.
        """
        last: Dict[int, Optional[Lane]] = {start: None}  # the lane by which a station is reached
        reached = [start]
        for station in reached:
            for number in self.stations[station].lanes:
                lane = self.lanes[number]
                if lane.destination not in last:
                    last[lane.destination] = lane
                    reached.append(lane.destination)
        if goal not in last:
            return None
        way: List[Lane] = []
        while (lane_to := last[way[-1].origin if way else goal]) is not None:
            way.append(lane_to)
        return way[::-1]


class Vehicle(NamedTuple):
    """An AGV of the fleet, with the fields of fp_agv."""

    name: str
    length_m: float
    width_m: float
    speed_mps: float
    acceleration_mps2: float
    deceleration_mps2: float
    turn_speed_radps: float
    turn_acceleration_radps2: float
    turn_deceleration_radps2: float
    loaded_length_m: float
    loaded_width_m: float
    speed_deviation: float
    centre_ahead_m: float
    reverse_speed_mps: float
    vehicle_type: int


class ComputerInfo(NamedTuple):
    name: str
    x_m: Optional[float]
    """Of its antenna; None: it has none, and is in range of every AGV."""
    y_m: Optional[float]


class Occupancy(NamedTuple):
    """What a vehicle covers of the floor: it stands at a station, or it turns into a lane and drives it to the end."""

    vehicle_type: int
    load: str = "any_load"
    """ "any_load" (the larger of both sizes), "empty_only" or "loaded_only"."""
    lane: Optional[int] = None
    """Its place in ``Map.lanes``; None: it stands."""
    station: Optional[int] = None
    heading: Optional[Tuple[float, float]] = None
    """With which it stands, or from which it turns into the lane; None: any."""


class World(NamedTuple):
    """What is the same for all participants of a run."""

    seed: str
    safety_distance_m: float
    radio_range_m: Optional[float]
    """None: no limit."""
    orders: str
    """ "assigned" or "open"."""
    fleet: Tuple[Vehicle, ...]
    computers: Tuple[ComputerInfo, ...]
    """Their ids follow those of the AGVs."""
    vehicle_type_names: Tuple[str, ...]
    segment_names: Tuple[str, ...]
    map: Map

    def id_of(self, name: str) -> int:
        """The id of the AGV or computer of this name. Raises KeyError if there is none."""
        names = [vehicle.name for vehicle in self.fleet] + [computer.name for computer in self.computers]
        if name not in names:
            raise KeyError(f"no participant has the name {name!r}; there are {', '.join(names)}")
        return names.index(name)


class Briefing(NamedTuple):
    """What a participant knows when it starts, in the words of fp_briefing."""

    self_id: int
    role: str
    """ "agv" or "computer"."""
    boot: int
    """How often its computer has restarted in this run."""
    config: str
    start_station: Optional[int]
    start_segment: Optional[int]
    next_segment: Optional[int]


def _pair(told: Optional[List[float]]) -> Optional[Tuple[float, float]]:
    return None if told is None else (told[0], told[1])


def _station(told: Dict[str, Any]) -> Station:
    return Station(
        told["name"],
        told["x_m"],
        told["y_m"],
        tuple(told["purposes"]),
        tuple(told["lanes"]),
        told["turning_forbidden"],
        _pair(told["heading"]),
    )


def _lane(told: Dict[str, Any]) -> Lane:
    return Lane(
        told["segment"],
        told["from"],
        told["to"],
        told["length_m"],
        tuple(Arc(Pose(*arc["start"]), arc["length_m"], arc["curvature_per_m"]) for arc in told["arcs"]),
        told["speed_limit_mps"],
        told["width_m"],
        tuple(told["blocks"]),
        told["backward"],
        tuple((each["vehicle_type"], each["load"]) for each in told["permissions"]),
    )


def read_world(told: Dict[str, Any]) -> World:
    """The world from the member ``run`` of a line."""
    plant = told["map"]
    return World(
        told["seed"],
        told["safety_distance_m"],
        told["radio_range_m"],
        told["orders"],
        tuple(Vehicle(*(agv[field] for field in Vehicle._fields)) for agv in told["fleet"]),
        tuple(ComputerInfo(each["name"], each["x_m"], each["y_m"]) for each in told["computers"]),
        tuple(told["vehicle_type_names"]),
        tuple(told["segment_names"]),
        Map(
            tuple(_station(each) for each in plant["stations"]),
            tuple(_lane(each) for each in plant["lanes"]),
            tuple(Block(each["name"], each["kind"]) for each in plant["blocks"]),
        ),
    )


def read_briefing(told: Dict[str, Any]) -> Briefing:
    """The briefing from an event ``start``."""
    return Briefing(
        told["self"],
        told["role"],
        told["boot"],
        told["config"],
        told["start_station"],
        told["start_segment"],
        told["next_segment"],
    )

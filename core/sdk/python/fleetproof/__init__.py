"""Control software for fleetproof in Python.

A program is an ordinary process that speaks lockstep (core/sdk/lockstep.md) over its standard input and output. This
package speaks it for you, in three styles:

* callbacks: a subclass of ``Callbacks``, one object for each participant;
* straight-line code: ``async def program(agv: StraightAgv)``, which waits for events and for nothing else;
* master: a subclass of ``Master`` for a computer, such as a server that plans for a fleet.

``serve`` starts either. Units: metres, seconds where a name ends in ``_s``, nanoseconds where it ends in ``_ns``.
Headings are unit vectors. ``None`` stands where agent.h has FP_NONE or FP_HERE. ``print`` goes to standard error, the
log of the worker: standard output belongs to the protocol.

Use no clock, thread, random source or module ``asyncio`` of your own: time and randomness come from the participant.
"""

from .callbacks import Callbacks, Master
from .participant import Agv, Computer, Participant, Result, Suspended
from .session import ProtocolError, serve
from .straight import Event, Kind, StraightAgv, StraightComputer
from .world import (
    BACKWARD,
    MESSAGE_BYTES_MAX,
    Arc,
    Block,
    Briefing,
    ComputerInfo,
    Fault,
    Lane,
    Map,
    Message,
    Occupancy,
    Order,
    Pose,
    Station,
    Vehicle,
    World,
)

__all__ = [
    "BACKWARD",
    "MESSAGE_BYTES_MAX",
    "Agv",
    "Arc",
    "Block",
    "Briefing",
    "Callbacks",
    "Computer",
    "ComputerInfo",
    "Event",
    "Fault",
    "Kind",
    "Lane",
    "Map",
    "Master",
    "Message",
    "Occupancy",
    "Order",
    "Participant",
    "Pose",
    "ProtocolError",
    "Result",
    "Station",
    "StraightAgv",
    "StraightComputer",
    "Suspended",
    "Vehicle",
    "World",
    "serve",
]

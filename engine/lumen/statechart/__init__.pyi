from lumen.clock.virtual import VirtualClock as VirtualClock
from lumen.language.events import Event as Event
from lumen.standalone.machine import Interpreter as Interpreter
from lumen.standalone.machine import Machine as Machine
from lumen.statechart.deserialization import deserialize as deserialize
from lumen.statechart.serialization import TimerPolicy as TimerPolicy
from lumen.statechart.serialization import paused as paused
from lumen.statechart.serialization import retimed as retimed
from lumen.statechart.serialization import serialize as serialize
from lumen.statechart.stepping import due as due
from lumen.statechart.stepping import elapse as elapse
from lumen.statechart.stepping import finished as finished
from lumen.statechart.stepping import initial as initial
from lumen.statechart.stepping import step as step
from lumen.statechart.values import Awaiting as Awaiting
from lumen.statechart.values import Counters as Counters
from lumen.statechart.values import Fork as Fork
from lumen.statechart.values import Halted as Halted
from lumen.statechart.values import Invoked as Invoked
from lumen.statechart.values import Position as Position
from lumen.statechart.values import Snapshot as Snapshot
from lumen.statechart.values import Step as Step
from lumen.statechart.values import Timer as Timer
from lumen.statechart.values import Within as Within

__all__ = ["Event", "Interpreter", "Machine", "Snapshot", "Step", "VirtualClock", "due", "initial", "step"]

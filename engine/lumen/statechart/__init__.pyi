from lumen.clocks.virtual import VirtualClock as VirtualClock
from lumen.interpreters.statechart.deserialization import deserialize as deserialize
from lumen.interpreters.statechart.serialization import TimerPolicy as TimerPolicy
from lumen.interpreters.statechart.serialization import paused as paused
from lumen.interpreters.statechart.serialization import retimed as retimed
from lumen.interpreters.statechart.serialization import serialize as serialize
from lumen.interpreters.statechart.stepping import due as due
from lumen.interpreters.statechart.stepping import elapse as elapse
from lumen.interpreters.statechart.stepping import finished as finished
from lumen.interpreters.statechart.stepping import initial as initial
from lumen.interpreters.statechart.stepping import step as step
from lumen.interpreters.statechart.values import Awaiting as Awaiting
from lumen.interpreters.statechart.values import Counters as Counters
from lumen.interpreters.statechart.values import Fork as Fork
from lumen.interpreters.statechart.values import Halted as Halted
from lumen.interpreters.statechart.values import Invoked as Invoked
from lumen.interpreters.statechart.values import Position as Position
from lumen.interpreters.statechart.values import Snapshot as Snapshot
from lumen.interpreters.statechart.values import Step as Step
from lumen.interpreters.statechart.values import Timer as Timer
from lumen.interpreters.statechart.values import Within as Within
from lumen.language.events import Event as Event
from lumen.statechart import Interpreter as Interpreter
from lumen.statechart import Machine as Machine

__all__ = ["Event", "Interpreter", "Machine", "Snapshot", "Step", "VirtualClock", "due", "initial", "step"]

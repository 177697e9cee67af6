"""A visit to the shipped tour as a stream of events: faces five times per second, sentences, and the robot's answers.

The robot finishes everything at once; timers end when they are due. Every step uses the pure `step`.
"""

from collections import deque
from collections.abc import Iterator
from pathlib import Path

from peers import Work

from lumen.language.commands import Start
from lumen.statechart import Event, Machine, Step, due, initial, step

TOUR = Path(__file__).parents[1] / "behaviors" / "tour.yaml"
SAID = (
    "My name is Dewi", "Not bad", "Who made you?", "And how do you keep looking at me?",
    "What is the capital of France?", "Then introduce yourself", "Can you dance?", "Speak Indonesian, please",
    "Tidak, terima kasih",
)  # fmt: skip
FACES, PERIOD = 10, 0.2


def happenings() -> Iterator[Event]:
    """Yield the events of one visitor after another, without end."""
    number = 0
    while True:
        for text in SAID:
            for _ in range(FACES):
                number += 1
                yield Event("face", {"x": 80.0 + number % 40, "y": 120.0}, number * PERIOD)
            yield Event("heard", {"result": text}, number * PERIOD)
        number += round(60 / PERIOD)  # a pause without visitors


def tour() -> Work:
    """Return the tour as work; each step counts, including those of timers and of the robot's answers."""
    machine = Machine.load(TOUR)

    def work(count: int) -> int:
        taken, done, waiting = initial(machine, language="en"), 0, deque[Event]()
        world, asked, timer = happenings(), None, None
        while done < count:
            now = taken.snapshot
            if taken.commands:
                waiting.extend(_answers(taken))
            event = waiting.popleft() if waiting else next(world)
            if asked is None or now.timers is not asked.timers or now.invoked is not asked.invoked:
                asked, timer = now, due(now)
            if timer and timer.at <= event.at:
                waiting.appendleft(event)
                event = timer
            taken = step(machine, now, event)
            done += 1
        return done

    return work


def _answers(taken: Step) -> Iterator[Event]:
    for command in taken.commands:
        if isinstance(command, Start):
            yield Event(f"done.command.{command.id}", None, taken.snapshot.at)

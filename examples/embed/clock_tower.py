"""A program of somebody else's that has an exhibition inside: a visitor comes, and the program hears what happens.

    python examples/embed/clock_tower.py [PROJECT]

It needs no robot, no broker and no terminal: the recording robot performs in simulated time.
"""

import sys

import lumen
from lumen.language.stories import Visitor
from lumen.statechart import Step


def tell(now: float, step: Step) -> None:
    """A line for each step that led somewhere."""
    if step.entered:
        print(f"{now:5.1f} s  {', '.join(sorted(step.entered))}")


def main(path: str | None = None) -> int:
    with lumen.open(path, robot="recording") as exhibition:
        exhibition.observe(lambda step: tell(exhibition.now, step))
        assert exhibition.visitor  # the recording robot stands in a hall of its own
        exhibition.visitor.arrive(Visitor())
        exhibition.run(seconds=10)
        exhibition.send("heard", {"result": "my name is Ada"})
        exhibition.run(seconds=5)
        print("remembered:", exhibition.context["visitor"])
        report = exhibition.reload()
        print("files:", report.verdict, *report.diagnostics)
        exhibition.stop()
        exhibition.run(seconds=2)
        print("at the end:", ", ".join(sorted(exhibition.configuration)))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:2]))

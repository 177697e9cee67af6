"""Measure the time from `ask` to the first word: by a passage, and by a language model that answers at once.

    python benchmarks/first_words.py

The model is a server in this process that answers without computing, so that only Lumen's part is measured. The table
has CPU time of this process, including the server, and wall time, which means little on a busy machine.
"""

import statistics
import sys
import time
from dataclasses import replace
from pathlib import Path

import lumen
from lumen.bus import connect
from lumen.features.answers.module import Answers
from lumen.language.causes import UNKNOWN_ORIGIN
from lumen.language.commands import Ask
from lumen.language.modules import ANSWERS, ModuleSettings
from lumen.run.questions import Questions

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.features.answers.fake_model import fake_model, says
from tests.waiting import until

TIMES = 30
KNOWN, UNKNOWN = "how tall are you", "would you like to live on the moon"


def main() -> int:
    """Print the medians."""
    project = lumen.load(str(Path(__file__).parents[1]))
    print(f"ask to the first word, the median of {TIMES}:")
    with fake_model(says("I do not ", "know. ", "Sorry.")) as model:
        options = {"model": {"url": model.url, "name": "fake"}, "budget": {"hour": TIMES + 1, "visitor": TIMES + 1}}
        ready = replace(project, modules={**project.modules, ANSWERS: ModuleSettings(True, options)})
        bus = connect("memory://", ready)
        questions, module = Questions(bus), Answers(ready, bus, print)
        questions.listen(ready)
        module.begin()
        try:
            for what, question in (("a passage", KNOWN), ("a model that answers at once", UNKNOWN)):
                costs, walls = [], []
                for number in range(TIMES):
                    cpu, wall = time.process_time(), time.perf_counter()
                    found = questions.ask(ready, f"d{number}", Ask(question, "en", 4.0), 0.0, UNKNOWN_ORIGIN)
                    if not found:
                        until(lambda: not questions.empty, every=0.0005)
                        found = questions.drain(0.0)
                    costs.append(1000 * (time.process_time() - cpu))
                    walls.append(1000 * (time.perf_counter() - wall))
                    assert found[0].data["text"], found
                    assert module.settle()
                    questions.drain(0.0)  # the rest of the answer
                print(f"  {what}: {statistics.median(costs):.1f} ms CPU, {statistics.median(walls):.1f} ms wall")
        finally:
            module.close()
            bus.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())

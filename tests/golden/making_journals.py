"""The script that recorded the inputs: `python -m tests.golden.making_journals [NAME …]`, or `snapshots`.

It has run once, on d475a3ac. What it records holds the date, and ids that are drawn: it is not the same again.
"""

import json
import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import lumen
import lumen.bus
from lumen.cli.main import main
from lumen.language.machines import MachineDefinition
from lumen.project.files import read_files
from lumen.project.home import Home
from lumen.run import rehearsal
from lumen.run.compose import compose
from lumen.run.loop import Observer
from lumen.run.plan import Plan
from lumen.run.services import Services
from lumen.run.snapshot_store import SnapshotStore
from lumen.statechart import Step, deserialize, serialize
from lumen.statechart.direct_entry import entered_directly
from tests.golden.golden import HERE, PROJECTS
from tests.guarded import PIPE, Guarded

JOURNALS = HERE / "journals"
BUNDLES = JOURNALS / "bundles"
HOMES = HERE / "homes"
SNAPSHOTS = HERE / "snapshots"
TOUR = "behaviors/tour.yaml"
STATE = ".lumen"
ASKED = "lumen.NAO.operator.request"


def copied(name: str, folder: Path) -> Path:
    """Copy a frozen project, or the duet, into `folder`; return the copy, which may be changed."""
    shutil.copytree(PROJECTS / name, folder / name)
    return folder / name


def edited(root: Path, file: str, *changes: tuple[str, str]) -> None:
    """Replace texts of a file, each of which is in there."""
    text = (root / file).read_text("utf-8")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    (root / file).write_text(text, "utf-8")


def played(name: str, story: str) -> Callable[[Path], Path]:
    """Return a function that plays a story from its beginning to its end."""

    def play(folder: Path) -> Path:
        root = copied(name, folder)
        with lumen.open(root, story=story) as exhibition:
            exhibition.run()
        return root

    return play


def duet(folder: Path) -> Path:
    """Play a visit with two robots in one hall."""
    root = copied("duet", folder)
    assert main(["run", str(root), "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    return root


def lived(exhibition: lumen.Exhibition, state: str) -> None:
    """Live until a state is active."""
    while state not in exhibition.configuration:
        assert exhibition.tick() < 300, f"{state} was never entered"


def text_changed(root: Path) -> None:
    edited(root, TOUR, ('en: "I am sorry, I did not understand that."', 'en: "Come again, please?"'))


def state_renamed(root: Path) -> None:
    for file in (root / "behaviors").rglob("*.yaml"):
        file.write_text(file.read_text("utf-8").replace("how_are_you", "feeling"), "utf-8")
    edited(root, TOUR, ("\nid: tour\n", "\nid: tour\nrenamed: {how_are_you: feeling}\n"))


def motion_replaced(root: Path) -> None:
    edited(root, TOUR, ("- {play: dance}", "- {play: photo}"))


def reload(folder: Path) -> Path:
    """Reload a changed text, another name of the active state, and another version of a motion that plays."""
    root = copied("tour", folder)
    store = SnapshotStore(Home(root / STATE))
    with lumen.open(root, story="visitor") as exhibition:
        for state, seconds, change, verdict in (
            ("ask_name", 0.5, text_changed, "applied"),
            ("how_are_you", 0.5, state_renamed, "applied"),
            ("dance", 5, motion_replaced, "waiting"),
        ):
            lived(exhibition, state)
            exhibition.run(seconds)
            change(root)
            store.store(read_files(root))
            assert exhibition.reload().verdict == verdict
        exhibition.run()
    return root


def goto(folder: Path) -> Path:
    """Let an operator have states entered, over the bus."""
    root = copied("museum", folder)
    bus = lumen.bus.connect("memory://golden-goto")
    asker = lumen.bus.connect("memory://golden-goto")
    with lumen.open(root, story="visit", bus=bus) as exhibition:
        for seconds, state in ((20, "praise"), (15, "tour"), (25, "quiz")):
            exhibition.run(seconds)
            asker.publish(
                "lumen.NAO.operator.request", {"ask": "goto", "state": state, "by": "Ada"}, reply_to="lumen.golden"
            )
        exhibition.run(60)
        asker.publish(ASKED, {"ask": "note", "text": "a visitor with a dog", "by": "Ada"})
        exhibition.run(30)
    asker.close()
    return root


def forgotten(folder: Path) -> Path:
    """Forget a visitor during their visit, after which another one comes."""
    root = copied("tour", folder)
    with lumen.open(root) as exhibition:
        for name in ("Budi", "Dewi"):
            exhibition.send("face", {"x": 160, "y": 120})
            exhibition.run(15)
            exhibition.send("heard", {"result": f"my name is {name}", "lang": "en"})
            exhibition.run(8)
            exhibition.send("heard", {"result": "I am fine", "lang": "en"})
            exhibition.run(10)
            if name == "Budi":
                exhibition.send("forgotten", {"name": name})
            exhibition.run(10)
            exhibition.send("heard", {"result": "no, thank you", "lang": "en"})
            exhibition.run(20)
    return root


def killed(folder: Path) -> Path:
    """Kill a run in a visit, let the next run resume it, and cut a journal in a frame.

    The home that the first run left is kept, except its socket and its .gitignore.
    """
    root = copied("tour", folder)
    kill(root)
    shutil.rmtree(HOMES / "tour", ignore_errors=True)
    shutil.copytree(root / STATE, HOMES / "tour", ignore=shutil.ignore_patterns("*.sock", ".gitignore", "*.new"))
    command = [sys.executable, "-m", "lumen", "run", root, "--robot", "recording", "--for", "4s"]
    with Guarded(command, stdin=PIPE, stdout=PIPE, text=True) as process:
        process.communicate()
    *_, last = sorted((root / STATE / "journal").glob("*.journal"))
    last.write_bytes(last.read_bytes()[:-100])
    return root


def kill(root: Path) -> None:
    """Let a visitor come and say their name; kill the run as the robot answers."""
    command = [sys.executable, "-m", "lumen", "run", root, "--robot", "recording"]
    with Guarded(command, stdin=PIPE, stdout=PIPE, text=True, bufsize=1) as process:
        assert process.stdin
        assert process.stdout
        process.stdin.write("hello\n")
        for line in process.stdout:
            if "May I know your name" in line or "What is your name" in line or "pleasure of meeting" in line:
                process.stdin.write("my name is Budi\n")
            if "Budi" in line and "robot" in line:
                break
        time.sleep(1.0)  # what was handed to the disk is written within half a second
        os.killpg(process.pid, signal.SIGKILL)


QUIZ = """
context: {right: 0}
states:
  asks:
    do: {say: {en: "How many legs has a spider?"}}
    on:
      heard:
        - guard: "event.data.result == 'eight'"
          target: over
          actions:
            - {assign: {right: context.right + 1}}
            - {send: {event: guessed, to: parent, data: {said: event.data.result}}}
        - {actions: {say: {en: "No. Once more?"}}}
    after: {20s: over}
  over: {type: final, output: "{'right': context.right}"}
"""
HOST = """
context: {points: 0, guesses: 0}
entry: {wake: true}
states:
  waiting: {on: {face: playing}}
  playing:
    initial: first
    states:
      first:
        invoke:
          id: quiz
          behavior: quiz
          onDone: {target: second, actions: {assign: {points: context.points + event.data.right}}}
      second: {invoke: {id: again, behavior: quiz, onDone: over}}
      over: {do: [{say: {en: "{{ context.points }} points."}}, {wait: 3s}], onDone: '#waiting'}
    on:
      guessed: {actions: {assign: {guesses: context.guesses + 1}}}
    after: {2min: waiting}
"""


def invoked(folder: Path) -> Path:
    """Invoke behaviours that answer, that run into their time limit, and that are left."""
    root = copied("minimal", folder)
    shutil.rmtree(root / "behaviors")
    (root / "behaviors").mkdir()
    (root / "behaviors/hello.yaml").write_text(HOST, "utf-8")
    (root / "behaviors/quiz.yaml").write_text(QUIZ, "utf-8")
    edited(root, "lumen.yaml", ("story: visitor", "# story: visitor"))
    with lumen.open(root) as exhibition:
        for words in (("six", "eight"), ("nine",), ()):
            exhibition.send("face", {"x": 160, "y": 120})
            exhibition.run(3)
            for word in words:
                exhibition.send("heard", {"result": word, "lang": "en"})
                exhibition.run(5)
            exhibition.run(50)
    return root


WEEKEND = """
title: From Sunday evening to Tuesday morning
at: "sun 17:54"
steps:
  - visitor: {x: 1.2, y: 0, height: 1.7}
  - expect: {state: welcome}
  - expect: {said: closes in five minutes, within: 10min}
  - expect: {state: closing, within: 10min}
  - expect: {state: closed, within: 2min}
  - visitor: leaves
  - at: "tue 09:59"
  - expect: {state: closed}
  - expect: {state: open, within: 2min}
"""


def weekend(folder: Path) -> Path:
    """Let timers run out days later, without a tick in between."""
    root = copied("museum", folder)
    (root / "behaviors/stories/weekend.yaml").write_text(WEEKEND, "utf-8")
    project = lumen.load(root)

    def journaled(plan: Plan) -> Services:
        return compose(replace(plan, options={"operated": True}))

    with patch.object(rehearsal, "compose", journaled):
        assert rehearsal.rehearse(project, project.stories["weekend"]).failed is None
    return root


JOURNALED: dict[str, Callable[[Path], Path]] = {
    "minimal": played("minimal", "visitor"),
    "tour": played("tour", "visitor"),
    "museum": played("museum", "visit"),
    "duet": duet,
    "answers": played("tour", "questions"),
    "reload": reload,
    "goto": goto,
    "forgotten": forgotten,
    "killed": killed,
    "invoked": invoked,
    "weekend": weekend,
    "outage": played("tour", "safety_brain"),
}


class Collected(Observer):
    """Keeps the first snapshot in which each state was just entered."""

    def __init__(self, machine: MachineDefinition) -> None:
        self.machine = machine
        self.snapshots: dict[str, dict[str, Any]] = {}

    def stepped(self, step: Step) -> None:
        for state in step.entered:
            if state not in self.snapshots:
                self.snapshots[state] = serialize(self.machine, step.snapshot)


def snapshots() -> None:
    """Write a snapshot of every state of the tour, from the first story that enters it, else entered by an operator."""
    project = lumen.load(PROJECTS / "tour")
    collected = Collected(project.machine)
    for story in project.stories.values():
        rehearsal.rehearse(project, story, observers=[collected])
    stands = deserialize(project.machine, collected.snapshots["how_are_you"])
    for state in project.machine.states.values():
        if state.path and state.name not in collected.snapshots:
            wanted = lumen.Event("operator.goto", None, stands.at + 1)
            with suppress(lumen.LumenError):
                collected.stepped(entered_directly(project.machine, stands, state.name, wanted))
    lines = (json.dumps({"state": state, **one}, ensure_ascii=False) for state, one in collected.snapshots.items())
    SNAPSHOTS.mkdir(exist_ok=True)
    (SNAPSHOTS / "tour.jsonl").write_text("".join(f"{line}\n" for line in lines), "utf-8")


def keep(root: Path, kept: Path) -> None:
    """Keep the journals of a project's home, and the bundles that they need."""
    shutil.rmtree(kept, ignore_errors=True)
    BUNDLES.mkdir(parents=True, exist_ok=True)
    for bundle in sorted(root.rglob("bundle-*.zip")):
        shutil.copyfile(bundle, BUNDLES / bundle.name)
    for journal in sorted(root.rglob("*.journal")):
        robot = journal.parts[journal.parts.index("robots") + 1] if "robots" in journal.parts else ""
        (kept / robot).mkdir(parents=True, exist_ok=True)
        shutil.copyfile(journal, kept / robot / journal.name)


if __name__ == "__main__":
    if "snapshots" in sys.argv[1:]:
        snapshots()
        sys.exit()
    for name in sys.argv[1:] or JOURNALED:
        with tempfile.TemporaryDirectory() as temporary:
            keep(JOURNALED[name](Path(temporary)), JOURNALS / name)

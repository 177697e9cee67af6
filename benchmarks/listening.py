"""Measure when the ears listen: what detects speech, and how often the robot hears itself.

    python benchmarks/listening.py

All voices are those of espeak-ng, all noise is artificial, and the echo is that of one wall: no hall, no visitor and
no loudspeaker was recorded, so only the differences between the rows matter. A sound has a second of silence before
and after the sentence.
"""

import argparse
import re
import statistics
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import sqrt
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import lumen
from lumen.bus import connect
from lumen.expressions.phrases import is_heard
from lumen.features.ears.expected import HeardName, expected, heard_names
from lumen.features.ears.module import Ears
from lumen.features.ears.recogniser import Recogniser
from lumen.features.ears.resampling import resampled
from lumen.features.ears.shared_recogniser import shared_sphinx
from lumen.features.ears.voice_activity import VoiceActivity
from lumen.features.voice.module import espeak
from lumen.language.machines import MachineDefinition
from lumen.language.modules import EARS, ModuleSettings
from lumen.language.projects import Project
from lumen.run.sound import Sound

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.waiting import Collector

Samples = NDArray[np.float64]
RATE = 16_000
VOICES = (("en-us", 150), ("en-us+f3", 190), ("en-us+m3", 120), ("en-us+f5", 150), ("id", 150), ("id+f3", 190))
NOISES: tuple[float | None, ...] = (None, 20.0, 10.0, 0.0)
VISITOR = """offer: can you dance for me;offer: how tall are you;offer: please sing a song;ask_name: my name is peter
offer: what happens at this booth;offer: tell me about yourself;how_are_you: i am fine thank you
offer: can we take a photo"""
"""The visitor's sentences, each with the state in which it is said."""
ROBOT = """Good morning!;May I know your name?;How are you, Ani?;I am glad to hear that.
What can I do for you? I can explain, dance, sing, or take a photo with you.;Do you have a question for me?
I am 57 centimetres tall.;With pleasure! Please leave me some room.;Thank you for listening!
I will sing Manuk Jajali for you.;My body was developed by Aldebaran Robotics.;I am sorry, I did not understand that."""
STOP, STOPPABLE = "stop", "dance"
"""A word that interrupts the robot, and a state in which it does."""
TALK = """the weather is nice;where can i buy something to drink;the train leaves at seven;my brother works in a bank
look at those people over there;the moon is very bright tonight;we parked the car behind the building
what time does the museum open;i left my umbrella at home;these shoes are too small;the children are playing outside
purple is her favourite colour"""
NEAR: Mapping[str, object] = {"x": 160, "y": 120, "distance": 1.2}
FAR: Mapping[str, object] = {"x": 40, "y": 120, "distance": 2.8}
"""Face messages for a visitor who looks at the robot, and for people farther away who talk to each other."""
NAMES = (
    ("en-us", "my name is", "peter maria susan budi ani rudi dewi putri robert yusuf"),
    ("id", "nama saya", "budi dewi siti rudi agus wahyu bambang sri"),
)
WALL_DELAY, WALL_LEVEL = 0.08, 0.3
"""The echo of a wall: its delay [s] and its level."""


def texts(lines: str) -> list[str]:
    """Return the texts between semicolons and line ends."""
    return re.split("[;\n]", lines.strip())


def in_states(lines: str) -> list[tuple[str, str]]:
    """Return the texts, each with its state."""
    return [(text, state) for state, text in (line.split(": ") for line in texts(lines))]


def around(machine: MachineDefinition, name: str) -> list[str]:
    """Return the names of the states that must be active with this one: itself, its ancestors, and the regions."""
    state = next(state for state in machine.states.values() if state.name == name)
    names = [machine.states[path].name for path in machine.root.children]
    while state.parent is not None and state.name not in names:
        names.append(state.name)
        state = machine.states[state.parent]
    return names


def spoken(text: str, voice: str, pace: int) -> Samples:
    """Return the sound of a text, at `pace` words per minute, without silence around it."""
    said = resampled(espeak().speak(text, voice, pace), RATE)
    samples = np.frombuffer(said.samples, "<i2").astype(float)
    loud = np.flatnonzero(np.abs(samples) > 200)
    return samples[loud[0] : loud[-1] + 1]


def loudness(samples: Samples) -> float:
    """Return the root mean square of the samples."""
    return sqrt(float(np.mean(samples**2)))


def sound(samples: Samples) -> Sound:
    """Return the samples as a sound of 16 bits."""
    return Sound(RATE, np.clip(samples, -32_768, 32_767).astype("<i2").tobytes())


def noise(length: int, seed: int, *, dull: bool = False) -> Samples:
    """Return white noise, or noise without high frequencies as behind a wall; its loudness is 1."""
    found = np.random.default_rng(seed).normal(0.0, 1.0, length)
    if dull:
        found = np.convolve(found, np.ones(40) / 40, "same")
    return found / loudness(found)


def rested(said: Samples, level: float | None, seed: int) -> Samples:
    """Return the speech between two pauses, with noise that is `level` [dB] below the voice; None means no noise."""
    whole = np.pad(said, RATE)
    if level is None:
        return whole
    return whole + noise(len(whole), seed, dull=seed % 2 == 0) * loudness(said) / 10 ** (level / 20)


def activity() -> None:
    """Measure voice activity detection: misses, delays of beginning and end, and false alarms."""
    finder = VoiceActivity()
    for level in NOISES:
        begins, ends, missed = [], [], 0
        pairs = [(text, *VOICES[i % len(VOICES)]) for i, (text, _) in enumerate(in_states(VISITOR) * 3)]
        for seed, (text, voice, pace) in enumerate(pairs):
            said = spoken(text, voice, pace)
            spans = [
                (b, e) for b, e in finder.spans(sound(rested(said, level, seed))) if e > 1 and b < 1 + len(said) / RATE
            ]
            if spans:
                begins.append(spans[0][0] - 1.0)
                ends.append(spans[-1][1] - 1.0 - len(said) / RATE)
            else:
                missed += 1
        late = f"begins {_ms(begins)}, ends {_ms(ends)}" if begins else ""
        print(f"  {_noise(level):12} missed {missed:2} of {len(pairs)}   {late}", flush=True)
    for name, dull in (("white", False), ("dull", True)):
        times = sum(len(finder.spans(sound(500.0 * noise(10 * RATE, seed, dull=dull)))) for seed in range(6))
        print(f"  {name + ' noise':12} taken for speech {times} times in a minute", flush=True)


def _ms(times: Sequence[float]) -> str:
    return f"{1000 * statistics.median(times):+.0f} ms ({1000 * min(times):+.0f} to {1000 * max(times):+.0f})"


def _noise(level: float | None) -> str:
    return "quiet" if level is None else f"{level:g} dB"


class Hall:
    """Ears in a hall in which the robot speaks; `knows` determines whether they are informed of its speech."""

    def __init__(self, project: Project, recogniser: Recogniser, *, knows: bool) -> None:
        self.now, self.knows, self.project = 0.0, knows, project
        self.bus = connect("memory://", project)
        self.heard = Collector()
        self.ears = Ears(project, self.bus, print, recogniser, VoiceActivity(), lambda: self.now)
        self.bus.subscribe(project.key_of("heard"), self.heard)
        self.ears.begin()

    def close(self) -> None:
        """Close the ears and the bus."""
        self.ears.close()
        self.bus.close()

    def listen(self, text: str, own: Samples, other: Samples, at: float) -> list[str]:
        """Return the texts heard in the robot's speech and its echo, while a visitor speaks from `at` [s] on."""
        length = max(len(own) + round(WALL_DELAY * RATE), round(at * RATE) + len(other)) + RATE // 2
        hall, begin, before = np.zeros(length), self.now + 10.0, len(self.heard.bodies)
        for delay, level in ((0.0, 1.0), (WALL_DELAY, WALL_LEVEL)):
            first = round(delay * RATE)
            hall[first : first + len(own)] += level * own
        hall[round(at * RATE) :][: len(other)] += other
        if self.knows:
            self._tell(begin, {"command": {"verb": "say", "id": "d1", "text": text}})
            self._tell(begin + len(own) / RATE, {"answer": {"id": "d1", "kind": "done"}})
        self.now = begin + length / RATE
        self.bus.publish(self.project.key_of("recording"), {"name": "hall", "content": sound(hall).text()})
        assert self.ears.settle(60.0)
        return [body["result"] for body in self.heard.bodies[before:]]

    def enter(self, state: str) -> None:
        """Report to the ears that the behaviour is in that state."""
        self._tell(self.now + 1.0, {"states": around(self.project.machine, state)})

    def overhear(self, said: Samples, faces: Mapping[str, object]) -> list[str]:
        """Return the texts heard from a person whose face messages are `faces`, ten times per second."""
        begin, before = self.now + 20.0, len(self.heard.bodies)
        for tenth in range(round(10 * len(said) / RATE)):
            self.now = begin + tenth / 10
            self.bus.publish(self.project.key_of("face"), dict(faces))
        self.now = begin + len(said) / RATE
        self.bus.publish(self.project.key_of("recording"), {"name": "hall", "content": sound(said).text()})
        assert self.ears.settle(60.0)
        return [body["result"] for body in self.heard.bodies[before:]]

    def _tell(self, at: float, body: dict[str, object]) -> None:
        self.now = at
        self.bus.publish(self.project.key_of("state"), {"robot": self.project.robot, "time": at, **body})
        assert self.ears.settle(60.0)


def half_duplex(project: Project) -> None:
    """Measure how often the robot hears itself, and whether it still hears visitors."""
    recogniser, nothing = shared_sphinx(), np.zeros(0)
    said = [(text, spoken(text, "en-us+m3", 150)) for text in texts(ROBOT)]
    for name, knows in (("always listening", False), ("half duplex", True)):
        hall = Hall(project, recogniser, knows=knows)
        try:
            hall.enter(STOPPABLE)
            itself = sum(bool(hall.listen(text, own, nothing, 0.0)) for text, own in said)
            stop, levels = spoken(STOP, "en-us+f3", 130), (0.3, 0.1)
            stops = {x: sum(bool(hall.listen(text, x * own, stop, 0.4)) for text, own in said) for x in levels}
            answers = []
            for (text, own), (words, state) in zip(said, in_states(VISITOR), strict=False):
                hall.enter(state)
                found = hall.listen(text, own, spoken(words, "en-us", 150), len(own) / RATE + 0.6)
                answers.append(found == [words])
        finally:
            hall.close()
        print(f"  {name:17} hears itself {itself:2} of {len(said)}")
        for level, stopped in stops.items() if knows else ():
            print(f"  {'':17} interrupted by `{STOP}` over its voice at {level:.0%} {stopped:2} of {len(said)}")
        print(f"  {'':17} an answer 0.6 s after it, word by word: {sum(answers)} of {len(answers)}", flush=True)


def talk_beside(project: Project) -> None:
    """Measure what is heard of people who talk beside the robot, and of a visitor who talks to it."""
    listens = {"face": {"within": 1.5, "after": 3}}
    settings = ModuleSettings(True, {"listens": listens})
    choosing = replace(project, modules={**project.modules, EARS: settings})
    recogniser = shared_sphinx()
    said = [(text, FAR, "offer") for text in texts(TALK)] + [(text, NEAR, state) for text, state in in_states(VISITOR)]
    for name, chosen in (("always listening", project), ("a face near and looking", choosing)):
        hall = Hall(chosen, recogniser, knows=True)
        try:
            for level in (None, 20.0):
                aside, taken, meant = [], [], []
                for seed, (text, faces, state) in enumerate(said):
                    voice, pace = VOICES[seed % 4]
                    hall.enter(state)
                    found = hall.overhear(rested(spoken(text, voice, pace), level, seed), faces)
                    heard = heard_names(project, around(project.machine, state))
                    meanings = [meant_by(heard, one) for one in found]
                    if faces is NEAR:
                        meant.append(any(meant_by(heard, text) <= one for one in meanings))
                    else:
                        aside.append(bool(found))
                        taken.append(any(meanings))
                talk = f"talk heard {sum(aside):2} of {len(aside)}, taken for something {sum(taken):2}"
                right = f"a visitor understood {sum(meant)} of {len(meant)}"
                print(f"  {name:23} {_noise(level):6} {talk}; {right}", flush=True)
        finally:
            hall.close()


def meant_by(heard: Sequence[HeardName], text: str) -> frozenset[str]:
    """Return the names of phrases that occur in a text, in any language; for answers, with the row."""
    rows = {f"{n} {i}": row.phrases for m, n in heard for i, row in enumerate(m.answers.get(n, ()))}
    phrases = {name: machine.phrases[name] for machine, name in heard if name in machine.phrases}
    return frozenset(name for name, table in (phrases | rows).items() if is_heard(text, table))


def names(project: Project) -> None:
    """Measure how many names are understood, and the confidence of right and wrong ones."""
    recogniser = shared_sphinx()
    recogniser.expect(expected(project, heard_names(project, around(project.machine, "ask_name"))))
    right, wrong = [], []
    for language, begin, those in NAMES:
        for seed, name in enumerate(those.split()):
            for voice, pace in ((language, 150), (f"{language}+f3", 170)):
                [*found] = recogniser.hypotheses(sound(rested(spoken(f"{begin} {name}", voice, pace), 20.0, seed)))
                sure = (found[0].confidence or 0.0) if found else 0.0
                (right if found and found[0].text == f"{begin} {name}" else wrong).append(sure)
    for what, those_sure in (("right", right), ("wrong", wrong)):
        print(
            f"  {what}: {len(those_sure):2}, of which asked back below 0.99: {sum(s < 0.99 for s in those_sure)}",
            flush=True,
        )


def main() -> None:
    project = lumen.load(str(Path(__file__).parents[1]))
    print("what finds speech, by the noise beneath it:")
    activity()
    print("the robot's own voice:")
    half_duplex(project)
    print("talk beside the robot by people who look elsewhere, and a visitor who looks at it:")
    talk_beside(project)
    print("names, with noise 20 dB below the voice:")
    names(project)


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()

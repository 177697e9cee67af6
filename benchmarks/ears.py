"""Measure when the ears listen (listening.py), and how many sentences they understand.

PocketSphinx is measured alone, with the expected sentences of all states of the tour, and with those of the active
states. espeak-ng says sentences that are in no story, in three voices each. A synthetic voice is not a visitor, and
white noise is not a hall, so only the ratios matter. A sentence is understood if the same phrases and questions of
its state are found in the recognised text as in the original. A false one is a phrase that is found in talk about
something else.
"""

import argparse
import re
import time
from collections.abc import Mapping, Sequence
from math import sqrt
from typing import NamedTuple

import listening
import numpy as np

import lumen
from lumen.features.ears.expected import expected, heard_names
from lumen.features.ears.resampling import resampled
from lumen.features.ears.sphinx import Sphinx
from lumen.features.voice.module import espeak
from lumen.language.projects import Project
from lumen.run.sound import Sound

ENGLISH = {
    "offer": """
hello robot can you dance please;would you please dance for us;i would like to see you dance;please sing a song for me
can you sing;i want to hear a song;could we take a picture together;i would like a selfie with you
please take a photo of us;tell me about yourself;can you explain this exhibition;what is this event about
what happens at this booth;please tell me about lumen;how tall are you;what is your height;how much do you weigh
how old are you;tell me your age please;who built you;who created you;what does your name mean
why are you called lumen;are you a boy or a girl;how many joints do you have;how many motors are in your body
do you have a camera;can you see me;how do you hear me;do you have microphones;why do you follow my face
how do you think;how do you decide what to do;do your parts send messages
no thank you;that is all;nothing more goodbye;speak indonesian please;in english please
""",
    "how_are_you": """
i am fine thank you;i am very well;i feel great today;i am happy to be here;not so good;i am a bit tired;i am sad today
""",
    "ask_name": "my name is peter;my name is maria;i am susan",
    "dance": "please stop;stop that;wait a moment",
}
INDONESIAN = {
    "offer": """
bisa menari;tolong menari untuk saya;nyanyi satu lagu;saya mau lagu;foto bersama;boleh berfoto
tolong jelaskan pameran ini;siapa kamu;berapa tinggi kamu;berapa umurmu;siapa yang membuat kamu
tidak cukup;sampai jumpa;bahasa inggris;berapa berat kamu;apa arti namamu;bisa melihat saya
""",
    "how_are_you": "saya baik;baik terima kasih;saya sehat;saya lelah",
    "ask_name": "nama saya budi;nama saya dewi;saya siti",
    "dance": "berhenti;tunggu",
}
VOICES = ("", "+f3", "+m3")
NOISES: Mapping[str, float | None] = {"quiet": None, "20 dB": 20.0}
PACE = 150
ALONE, ALL, ACTIVE = "alone", "all states", "active states"


class Spoken(NamedTuple):
    """A sentence, its sound, and the state in which it is said."""

    text: str
    sound: Sound
    state: str


def spoken(sentences: Mapping[str, str], language: str, noise: float | None) -> list[Spoken]:
    """Return each sentence with the next voice, and noise that is `noise` [dB] below the voice; None means no noise."""
    random = np.random.default_rng(1)
    found = []
    pairs = [(text, state) for state, lines in sentences.items() for text in re.split("[;\n]", lines.strip())]
    for i, (text, state) in enumerate(pairs):
        said = resampled(espeak().speak(text, language + VOICES[i % len(VOICES)], PACE), 16_000)
        samples = np.frombuffer(said.samples, "<i2").astype(float)
        if noise is not None:
            loud = sqrt(float(np.mean(samples[np.abs(samples) > 200] ** 2)))
            samples = samples + random.normal(0.0, loud / 10 ** (noise / 20), samples.shape)
        found.append(Spoken(text, Sound(16_000, np.clip(samples, -32_768, 32_767).astype("<i2").tobytes()), state))
    return found


def wrong(text: str, found: str) -> int:
    """Return the edit distance of two texts [words]."""
    there = found.split()
    row = list(range(len(there) + 1))
    for i, word in enumerate(text.split(), 1):
        before, row[0] = row[0], i
        for j, other in enumerate(there, 1):
            before, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, before + (word != other))
    return row[-1]


def line(project: Project, told: str, said: Sequence[Spoken], talk: Sequence[Spoken]) -> str:
    """Return the row of results for a recogniser with these expectations."""
    heard = {one.state: heard_names(project, listening.around(project.machine, one.state)) for one in (*said, *talk)}
    by_state = {state: expected(project, names) for state, names in heard.items()} if told == ACTIVE else {}
    everything = expected(project, heard_names(project, None)) if told == ALL else []
    recogniser = Sphinx()
    recogniser.expect(everything)
    recogniser.recognise(said[0].sound)
    begin, found = time.process_time(), []
    for one in (*said, *talk):
        recogniser.expect(by_state.get(one.state, everything))
        found.append(recogniser.recognise(one.sound))
    spent = (time.process_time() - begin) / sum(one.sound.duration for one in (*said, *talk))
    pairs = list(zip(said, found, strict=False))
    words = 1 - sum(wrong(one.text, text) for one, text in pairs) / sum(len(one.text.split()) for one in said)
    whole = sum(one.text == text for one, text in pairs) / len(said)

    def meant(one: Spoken, text: str) -> frozenset[str]:
        return listening.meant_by(heard[one.state], text)

    understood = sum(meant(one, one.text) == meant(one, text) for one, text in pairs) / len(said)
    false = sum(bool(meant(o, t) - meant(o, o.text)) for o, t in zip(talk, found[len(said) :], strict=True))
    parts = f"words {words:4.0%}   sentences {whole:4.0%}   understood {understood:4.0%}"
    return f"{parts}   false {false} of {len(talk)}   {spent:.2f} s of CPU a second"


def main() -> None:
    listening.main()
    project = lumen.load(".")
    print("what is understood, by what the recogniser is told to expect:")
    for noise, level in NOISES.items():
        talk = spoken({"offer": listening.TALK}, "en-us", level)
        for language, sentences in (("en-us", ENGLISH), ("id", INDONESIAN)):
            said = spoken(sentences, language, level)
            for told in (ALONE, ALL, ACTIVE):
                print(f"{language:6} {noise:6} {told:14} {line(project, told, said, talk)}", flush=True)


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()

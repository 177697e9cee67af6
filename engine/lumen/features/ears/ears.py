"""The module that recognises speech in sounds and publishes the texts."""

import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from lumen.errors import ModuleError
from lumen.features.ears.addressing import NOBODY, SPEAKS, Addressing
from lumen.features.ears.expected import HeardName, expected, heard_names
from lumen.features.ears.own_voice import OwnVoice, Utterance
from lumen.features.ears.recogniser import Hypothesis, Recogniser, hypotheses
from lumen.features.ears.shared_recogniser import shared_sphinx
from lumen.features.ears.voice_activity import VoiceActivity, voice_activity
from lumen.language.diagnostics import did_you_mean
from lumen.language.iso_time import iso_time
from lumen.language.modules import EARS, ModuleSettings
from lumen.language.projects import Project
from lumen.ports import Bus, Message, MessageHandler
from lumen.run.module import Module
from lumen.run.sound import Sound, sound_of

LOST_AFTER = 4.0
"""The time for which the states of a silent brain remain valid [s]."""


class ActiveStates:
    """The active states of one robot's behaviour, from the routes `state` and `presence`.

    A brain that has not announced its presence, such as one within this process, never counts as lost.
    """

    def __init__(self, robot: str) -> None:
        self._robot = robot
        self._names: frozenset[str] | None = None
        self._until = float("inf")

    def state(self, body: Any, at: float) -> None:
        """Read a message about the behaviour that arrived at a time [s]; messages without `states` are ignored."""
        match body:
            case {"robot": self._robot, "states": list(states)}:
                self._names = frozenset(map(str, states))
                self._until = max(self._until, at + LOST_AFTER)

    def presence(self, body: Any, at: float) -> None:
        """Read a process's presence message that arrived at a time [s]; only those of the robot's brain count."""
        match body:
            case {"robot": self._robot, "parts": list(parts), "state": "here"} if "brain" in parts:
                self._until = at + LOST_AFTER

    def names(self, at: float) -> frozenset[str] | None:
        """Return the names of the active states at a time [s], as received by `state`; None if they are unknown."""
        if at > self._until:
            self._names = None
        return self._names


INTERRUPTS = ("stop",)
"""The default names of the phrases that are heard while the robot speaks."""
TICK = 0.05
"""The time resolution at which changes of listening are published [s]."""
PADDING = 0.3
"""The time before and after speech that the recogniser also receives [s]."""


class Ears(Module):
    """The speech half of the audio module, which turns the robot's recordings and other programs' sounds into texts.

    It is half duplex: while the robot speaks, and until its echo has faded, only phrases that interrupt it are heard.
    The same applies if `listens` is set and the robot is not addressed. The expected and the interrupting phrases
    depend on the states that are active when a sound arrives, which is assumed to be the sound's end. Changes of
    listening, with their reasons, are published on the route `listening`. A recogniser and a speech detector can be
    passed in. The default recogniser is PocketSphinx, or the Whisper model in the settings; the default detector is
    Silero's network. Raises ModuleError if the recogniser is missing.
    """

    name = EARS

    def __init__(
        self,
        project: Project,
        bus: Bus,
        tell: Callable[[str], None],
        recogniser: Recogniser | None = None,
        activity: VoiceActivity | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(project, bus, tell, clock)
        self._activity = activity if recogniser else voice_activity()
        self._recogniser = recogniser or _recogniser(project, self.settings.options)
        self._expected: Sequence[Sequence[str]] = ()
        self._own_voice, self._active = OwnVoice(), ActiveStates(project.robot)
        self._addressing = Addressing(self.settings.options.get("listens", {}), self.tell)
        self._shown: dict[str, object] = {}

    def hears(self) -> Mapping[str, MessageHandler]:
        """Return the handlers of the routes that the module listens to."""
        return {
            "recording": self._sound,
            "wav_stream": self._sound,
            "state": self._state,
            "presence": lambda message: self._active.presence(message.body, self.came),
            "report": lambda message: self._own_voice.report(message.body, self.came),
            **dict.fromkeys(self._addressing.routes(), lambda _: None),
        }

    def begin(self) -> None:
        """Start the module and check its settings."""
        super().begin()
        self._look_for_phrases()

    def use(self, project: Project) -> None:
        """Use the settings of another bundle."""
        options = project.modules.get(self.name, ModuleSettings()).options
        if options.get("listens", {}) != self.settings.options.get("listens", {}):
            self._addressing = Addressing(options.get("listens", {}), self.tell)
        super().use(project)
        self._look_for_phrases()

    def idle(self) -> float | None:
        """Publish whether the ears listen and why, if that has changed; return the time until the next change [s].

        Return None if no change is foreseen.
        """
        now = self.clock()
        because, until = self._addressing.state(now)
        if own := self._own_voice.during(now, now + TICK):
            because, until = SPEAKS, min(u.end for u in own)
        shown: dict[str, object] = {"listening": because not in (SPEAKS, NOBODY), "because": because}
        if shown != self._shown:
            self._shown = shown
            self.publish("listening", shown)
        return None if until == float("inf") else max(TICK, until - now)

    def _take(self, route: str, message: Message) -> None:
        """Let faces and touches open the ears at once, even while an earlier sound is recognised; queue the message."""
        if take := self._addressing.routes().get(route):
            take(message.body, self.clock())
        super()._take(route, message)

    def _look_for_phrases(self) -> None:
        """Report names in `interrupts` that no state hears, because they have no effect."""
        known = dict.fromkeys(one.name for one in heard_names(self.project, None) if "." not in one.name)
        for name in self.settings.options.get("interrupts", ()):
            if name not in known:
                hint = did_you_mean(name, known)
                self.tell(f"`interrupts` has `{name}`, which no state hears{f' ({hint})' if hint else ''}")

    def _state(self, message: Message) -> None:
        self._own_voice.state(message.body, self.came)
        self._active.state(message.body, self.came)

    def _heard_names(self) -> list[HeardName]:
        return heard_names(self.project, self._active.names(self.came))

    def _sound(self, message: Message) -> None:
        body = message.body if isinstance(message.body, dict) else {}
        language = str(body.get("language") or self._recogniser.languages[0])
        if language.partition("-")[0] not in self._recogniser.languages:
            known = ", ".join(self._recogniser.languages)
            raise ModuleError(f"the ears understand only {known}, not `{language[:20]}`: type what was said")
        found = self._heard(sound_of(body.get("content")))
        if found:
            date = iso_time(time.time(), "seconds", offset=True)
            about = {"name": str(body.get("name", "")), "date": date, "language": language}
            best, *others = [_row(one) for one in found]
            self.publish("heard", {**about, **best, **({"alternatives": others} if others else {})})
        self.well()

    def _heard(self, sound: Sound) -> Sequence[Hypothesis]:
        """Return the possible texts of a sound that has just ended, the likeliest first; none if it has no speech.

        Only the likeliest text can interrupt the robot, because alternatives for its own words often contain a phrase.
        """
        began = self.came - sound.duration
        own = self._own_voice.during(began, self.came)
        deaf = [*((u.begin, u.end) for u in own), *self._addressing.closed(began, self.came)]
        left = sound.without([(begin - began, end - began) for begin, end in deaf])
        found = self._words(left) if not deaf or left.samples.strip(b"\0") else []
        if found or not deaf:
            return found
        names = self.settings.options.get("interrupts", INTERRUPTS)
        sought = [one for one in self._heard_names() if one.name in names]
        likeliest = self._words(sound, own)[:1] if sought else []
        phrase = next((_interrupting(one.text, sought, own) for one in likeliest), "")
        return [Hypothesis(phrase)] if phrase else []

    def _words(self, sound: Sound, own: Sequence[Utterance] = ()) -> Sequence[Hypothesis]:
        """Return the likely texts of a sound, the best first; the robot's `own` utterances are expected in it."""
        if self._activity:
            spans = self._activity.spans(sound)
            if not spans:
                return []
            sound = sound.between(spans[0][0] - PADDING, spans[-1][1] + PADDING)
        sentences = expected(self.project, self._heard_names(), [u.text for u in own])
        if sentences != self._expected:
            self._expected = sentences
            self._recogniser.expect(sentences)
        return hypotheses(self._recogniser, sound)


def _interrupting(text: str, sought: Sequence[HeardName], own: Sequence[Utterance]) -> str:
    """Return a phrase of the names `sought` in a text, except those that the robot says itself; empty if there is none.

    It is the longest such phrase of the first name that has one.
    """
    for one in sought:
        finder = one.finder()
        said, ours = finder.read(text), " ".join(f" {' '.join(finder.read(u.text).words)} " for u in own)
        for find in sorted(said.finds.get(one.name, ()), key=lambda find: find.start - find.end):
            if f" {' '.join(said.words[find.start : find.end])} " not in ours:
                return said.said(find.start, find.end)
    return ""


def _row(found: Hypothesis) -> dict[str, object]:
    """Return a hypothesis as fields of a message; `confidence` is left out if unknown."""
    sure = {} if found.confidence is None else {"confidence": round(found.confidence, 3)}
    return {"result": found.text, **sure}


def _recogniser(project: Project, options: Mapping[str, Any]) -> Recogniser:
    """Return the recogniser that lumen.yaml selects; only its own packages are needed."""
    folder = options.get("whisper")
    if folder is None:
        return shared_sphinx()
    from lumen.features.ears.whisper import shared_whisper

    return shared_whisper(Path(project.root) / folder, project.languages)

"""Cues of motions: their words become `Say` commands, their sounds `PlaySound`, their skills `Do`."""

import logging
from collections.abc import Mapping
from pathlib import Path

from lumen.language.commands import BodyCommand, Cancel, Command, Play, PlaySound, Say, Start
from lumen.language.events import CUE, Event
from lumen.language.motions import skill_of
from lumen.language.projects import Project
from lumen.project.sounds import sound_duration

_log = logging.getLogger(__name__)


class MotionCues:
    """A translator from a motion's cue events to commands.

    Texts wait for the voice like every `say`, under ids `cue1`, `cue2`, …. If a motion is cancelled or fails, its
    texts, sounds and skills are cancelled. A sound that is missing or can't be played is logged once and left out.
    """

    def __init__(self) -> None:
        self._playing: dict[str, str] = {}
        self._saying: dict[str, str] = {}
        self._lacking: set[str] = set()
        self._number = 0

    def performing(self, command: Command) -> None:
        """Remember the id of a motion that is about to be played."""
        match command:
            case Start(id, Play(motion)):
                self._playing[id] = motion

    def answered(self, event: Event, project: Project, language: str) -> list[Command]:
        """Return the commands that follow from an event.

        These are the command of a cue, or the cancellations of a motion's commands if it was cancelled or failed.
        """
        if event.name == CUE and isinstance(event.data, Mapping):
            return self._cue(event.data, project, language)
        kind, _, id = event.name.partition(".command.")
        self._saying.pop(id, None)
        motion = self._playing.pop(id, None)
        if motion is None or kind == "done":
            return []
        return [Cancel(said) for said, by in self._saying.items() if by == motion]

    def _cue(self, data: Mapping[str, object], project: Project, language: str) -> list[Command]:
        motion, kind, value = str(data.get("motion", "")), data.get("kind"), data.get("value")
        if kind == "say" and (text := words(value, language, project.languages[0])):
            return [self._begin(Say(text, language), motion)]
        if kind == "sound":
            return self._sound(str(value), motion, project)
        skill = skill_of(kind, value)
        return [self._begin(skill, motion)] if skill else []

    def _begin(self, command: BodyCommand, motion: str) -> Start:
        """Return the command that begins a motion's text, sound or skill, and remember that it ends with the motion."""
        self._number += 1
        id = f"cue{self._number}"
        self._saying[id] = motion
        return Start(id, command)

    def _sound(self, file: str, motion: str, project: Project) -> list[Command]:
        try:
            sound_duration(Path(project.root), file)
        except (OSError, ValueError) as error:
            if file not in self._lacking:
                self._lacking.add(file)
                _log.warning("the motion `%s` can't play the sound `%s`: %s", motion, file, error)
            return []
        return [self._begin(PlaySound(file), motion)]


def words(value: object, language: str, default: str) -> str:
    """Return the text of a `say` in `language`, else in `default`, else in any language; empty if it has no text."""
    if isinstance(value, Mapping):
        value = value.get(language) or value.get(default) or next(iter(value.values()), "")
    return value if isinstance(value, str) else ""

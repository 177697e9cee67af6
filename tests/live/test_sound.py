"""A sound is heard on this machine's player, and in a film of the run, at its time."""

import math
import os
import sys
from array import array
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import imageio_ffmpeg
import numpy as np
import pytest

from lumen.cli.main import main
from lumen.language.commands import PlaySound
from lumen.project.sounds import sound_duration
from lumen.run.audio_track import RATE, AudioTrack
from lumen.run.loudspeaker import PLAYERS, Loudspeaker
from lumen.run.sound import Sound, save
from tests.guarded import run_guarded
from tests.tables import for_each
from tests.waiting import until

TONE, LENGTH = 880.0, 0.5
MAIN = """
name: Bell
behavior: bell
robot: {name: NAO, model: nao}
hall: hall.xml
languages: [en]
"""
BEHAVIOR = """
initial: idle
states:
  idle: {after: {300ms: ring}}
  ring:
    do: [{sound: sounds/bell.wav}]
    onDone: over
  over: {do: [{play: nod}]}
"""
MOTION = """
start: Stand
units: {angle: deg}
keyframes:
  - {at: 0s, sound: sounds/bell.wav}
  - {at: 300ms, joints: {HeadPitch: 10}}
"""


def bell(length: float = LENGTH, rate: int = 16_000) -> Sound:
    samples = (round(16_000 * math.sin(2 * math.pi * TONE * i / rate)) for i in range(round(length * rate)))
    return Sound(rate, array("h", samples).tobytes())


@pytest.fixture
def project(tmp_path: Path) -> Path:
    for folder in ("behaviors", "motions", "sounds"):
        (tmp_path / "bell" / folder).mkdir(parents=True)
    root = tmp_path / "bell"
    (root / "lumen.yaml").write_text(MAIN)
    (root / "behaviors/bell.yaml").write_text(BEHAVIOR)
    (root / "motions/nod.yaml").write_text(MOTION)
    save(root / "sounds/bell.wav", bell())
    return root


def loudness(samples: Any, rate: int = RATE, window: float = 0.02) -> Any:
    """Return the loudness of the tone in each window."""
    size = round(rate * window)
    parts = samples[: len(samples) // size * size].reshape(-1, size) * np.hanning(size)
    turn = np.exp(-2j * np.pi * TONE * np.arange(size) / rate)
    return np.abs(parts @ turn) / size


@pytest.mark.pictures
@pytest.mark.physics
def test_a_film_has_the_sounds_of_the_run_at_their_times(project: Path, tmp_path: Path) -> None:
    film = tmp_path / "film.mp4"
    command = ["run", str(project), "--speed", "max", "--for", "2s", "--video", str(film), "--size", "320x240"]
    done = run_guarded([sys.executable, "-m", "lumen", *command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("sounds sounds/bell.wav") == 2
    exe = imageio_ffmpeg.get_ffmpeg_exe()
    decode = [exe, "-v", "error", "-i", str(film), "-map", "0:a", "-f", "s16le", "-ac", "1", "-ar", str(RATE), "-"]
    heard = np.frombuffer(run_guarded(decode, capture_output=True, check=True).stdout, "<i2").astype(float)
    loud = np.flatnonzero(loudness(heard) > 1_000) * 0.02
    gaps = [(a, b) for a, b in pairwise(loud) if b - a > 0.05]
    starts, ends = [loud[0], *(b for _, b in gaps)], [*(a for a, _ in gaps), loud[-1]]
    assert len(starts) == 2, "one of the behaviour, one of its motion"
    assert starts[0] == pytest.approx(0.3, abs=0.1)
    assert [end - start for start, end in zip(starts, ends, strict=True)] == pytest.approx([LENGTH, LENGTH], abs=0.06)
    assert starts[1] >= ends[0]
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(film))
    assert len(heard) / RATE == pytest.approx(seconds, abs=0.1)
    assert frames == 51


def test_a_track_mixes_what_overlaps_and_ends_what_was_cut() -> None:
    track = AudioTrack()
    track.add(bell(1.0), 0.5)
    cut = track.add(bell(1.0, RATE), 1.0)
    cut(1.25)
    track.add(bell(1.0), 9.0)
    mixed = np.frombuffer(track.mixed(3.0).samples, "<i2").astype(float)
    loud = loudness(mixed)
    assert len(mixed) == 3 * RATE
    assert loud[:24].max() == 0.0
    assert loud[27:48].min() > 3_000
    assert loud[76:].max() == 0.0


@pytest.mark.process
def test_it_is_played_by_the_player_of_this_machine(
    project: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    player, played = tmp_path / PLAYERS[0][0], tmp_path / "played"
    player.write_text(f'#!/bin/sh\necho "$@" > {played}.new; mv {played}.new {played}; exec sleep 60\n')
    player.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    speaker = Loudspeaker(project)
    end = speaker.play(PlaySound("sounds/bell.wav", LENGTH), 1.0, 0.0)
    until(played.exists)
    assert played.read_text().split() == [*PLAYERS[0][1:], str(project / "sounds/bell.wav")]
    end(0.5)
    speaker.play(PlaySound("sounds/bell.wav", LENGTH), 1.0, 1.0)
    speaker.play(PlaySound("no\0file", LENGTH), 1.0, 1.0)
    speaker.close()


@pytest.mark.process
@pytest.mark.physics
def test_each_robot_of_a_house_plays_its_sounds(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    played = list[tuple[str, Path]]()

    def play(speaker: Loudspeaker, sound: PlaySound, volume: float, now: float) -> Callable[[float], None]:
        played.append((sound.file, speaker._root))
        return lambda then: None

    monkeypatch.setattr(Loudspeaker, "play", play)
    robots = "robots: {ana: {model: nao, at: {x: 0, y: -0.5}}, ben: {model: nao, at: {x: 0, y: 0.5}}}"
    (project / "lumen.yaml").write_text(MAIN.replace("robot: {name: NAO, model: nao}", robots))
    assert main(["run", str(project), "--robot", "simulation", "--speed", "max", "--for", "500ms"]) == 0
    assert played == [("sounds/bell.wav", project)] * 2


def test_that_there_is_no_player_is_said_once(
    project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", "")
    speaker = Loudspeaker(project)
    for now in (0.0, 1.0):
        speaker.play(PlaySound("sounds/bell.wav", LENGTH), 1.0, now)(now + LENGTH)
    assert capsys.readouterr().err == "No sound player is installed: sounds are silent, but take as long as usual.\n"


@for_each(
    ("content", "reason"),
    [
        (b"", "it is not a WAV file"),
        (b"RIFF\0\0\0\0WAVE", "it is not a WAV file"),
        (b"ID3\3" + bytes(100), "it is not a WAV file"),
        (b"RIFF\x24\0\0\0WAVEfmt \x10\0\0\0\1\0\1\0\x40\x1f\0\0\x40\x1f\0\0\1\0\x08\0data\0\0\0\0", "bits: 8"),
        (b"RIFF\x24\0\0\0WAVEfmt \x10\0\0\0\1\0\1\0\x40\x1f\0\0\x80\x3e\0\0\2\0\x10\0data\0\0\0\0", "empty"),
        (b"RIFF\x24\0\0\0WAVEfmt \x10\0\0\0\1\0\1\0\0\0\0\0\x80\x3e\0\0\2\0\x10\0data\2\0\0\0\0\0", "0 Hz"),
    ],
)
def test_what_is_no_sound_says_why(tmp_path: Path, content: bytes, reason: str) -> None:
    (tmp_path / "it.wav").write_bytes(content)
    with pytest.raises(ValueError, match=reason):
        sound_duration(tmp_path, "it.wav")
    with pytest.raises(FileNotFoundError):
        sound_duration(tmp_path / "project", "../it.wav")

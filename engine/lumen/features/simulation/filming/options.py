"""The options `--video` and `--size`, which set a video's file and picture size."""

import argparse
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lumen.cli.streams import complain
from lumen.errors import UsageError
from lumen.features.simulation.filming.progress import FilmProgress
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.run.audio_track import AudioTrack


def film_path(path: Path | None, robot: str) -> Path | None:
    """Return `path` after checking it; None if it is None.

    Raises UsageError if `robot` is not `simulation`, or if no .mp4 can be written to `path`.
    """
    if path is None:
        return None
    if robot != "simulation":
        raise UsageError("--video records the simulation: leave out --robot")
    if path.suffix != ".mp4" or not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise UsageError(
            f"can't write a video to {path}: name an .mp4 file in an existing folder that you can write to"
        )
    return path


FILM_SIZE = (1920, 1080)
MIN_FILM_SIDE, MAX_FILM_SIDE = 64, 4096
"""The range of the picture's width and height [px]."""


def configure_size(parser: argparse.ArgumentParser) -> None:
    """Add `--size` to the parser of a command that has `--video`."""
    usual = "x".join(map(str, FILM_SIZE))
    parser.add_argument(
        "--size", default=usual, metavar="WIDTHxHEIGHT", help=f"size of the video [px] (default: {usual})"
    )


def film_size(text: str) -> tuple[int, int]:
    """Return (width, height) [px] from a text such as `1280x720`.

    Raises UsageError if the text has another form, or a number is odd or out of range.
    """
    match = re.fullmatch(r"(\d{1,5})[x×](\d{1,5})", text)
    sides = (int(match[1]), int(match[2])) if match else (0, 0)
    if any(side % 2 or not MIN_FILM_SIDE <= side <= MAX_FILM_SIDE for side in sides):
        wanted = f"write two even numbers from {MIN_FILM_SIDE} to {MAX_FILM_SIDE}, such as 1280x720"
        raise UsageError(f"invalid `--size {text}`: {wanted}")
    return sides


@dataclass(frozen=True, slots=True)
class FilmPlan:
    """The settings for a video of a simulated robot."""

    path: Path
    track: AudioTrack | None = None
    """The soundtrack; None for a silent film."""
    size: tuple[int, int] | None = None
    """The width and height of the picture [px]; None for the default."""
    progress: FilmProgress | None = None
    """The progress display for the terminal; None for no display."""


class FilmOptions:
    """`--video` and `--size` of `lumen run`."""

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Add the options to the parser."""
        add = parser.add_argument
        add("--video", metavar="FILE.mp4", type=Path, help="save a video of the run (simulation only; needs OpenGL)")
        configure_size(parser)

    def check(self, options: argparse.Namespace, parts: Sequence[str], robots: int) -> None:
        """Raise UsageError if a video is requested with several robots or with `--only`."""
        if options.video and robots > 1:
            raise UsageError("--video works with only one robot: choose it with `--robot-name NAME`")
        if options.video and parts:
            raise UsageError("--video works only if everything runs in one process: leave out --only")

    def wishes(
        self, options: argparse.Namespace, project: Project, story: Story | None, period: float | None
    ) -> Mapping[str, Any]:
        """Return the run's options for the film, its soundtrack and its path; empty without `--video`.

        Raises UsageError if the path or the size is invalid.
        """
        video, size = film_path(options.video, options.robot), film_size(options.size)
        if video is None:
            return {}
        track = AudioTrack()
        film = FilmPlan(video, track, size, film_progress(project, story, period))
        return {"film": film, "track": track, "video": video}


def film_progress(project: Project, story: Story | None, period: float | None) -> FilmProgress:
    """Return the progress display of a film as long as the story or `period` [s], whichever is shorter.

    The recording robot rehearses the story to find its length. Without both, the length is unknown (0).
    """
    from lumen.run.rehearsal import rehearse  # imported late: few runs are filmed

    lengths = [length for length in (rehearse(project, story).time if story else None, period) if length]
    return FilmProgress(complain, min(lengths, default=0.0))

"""Make the moving picture of the README, docs/pictures/visit.webp: a visitor says goodbye; the robot answers and waves.

    python docs/pictures/visit.py                    # film the story below, and convert it
    python docs/pictures/visit.py --film FILE.mp4    # convert this film; if it is missing, make it first

`lumen run --story … --video` makes the film, in some minutes without a graphics card. The robot answers at once, so the
film shows the visitor's last words for one frame only. The picture shows them for the two seconds before the answer.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import imageio_ffmpeg
import numpy as np
from PIL import Image

from lumen.features.simulation.lettering import VISITOR_COLOUR, subtitle

ROOT = Path(__file__).parents[2]
PROJECT = ("lumen.yaml", "behaviors", "functions", "knowledge", "fuzzy", "motions", "models", "schemas")
PICTURE = Path(__file__).with_suffix(".webp")
SIDE = 480
"""Side of the square picture [px]: on a phone, its subtitles are still 12 pixels high."""

LEAD, LENGTH, RATE = 2.3, 8.0, 12.5
"""Time shown before the answer [s], length of the picture [s], frames per second."""

LAST_WORDS = "No, that is all. Goodbye!"
STORY = f"""\
title: A visitor says goodbye, and the robot waves
at: "10:30"
steps:
  - visitor: {{x: 1.1, y: 0.35, height: 1.5}}
  - expect: {{state: ask_name, within: 20s}}
  - wait: 3s
  - says: My name is Ani
  - expect: {{state: how_are_you, context: {{visitor: Ani}}}}
  - wait: 3s
  - says: I am fine, thank you
  - expect: {{state: offer}}
  - wait: 7s
  - says: How tall are you?
  - expect: {{state: answer, said: 57 centimetres}}
  - expect: {{state: any_question}}
  - wait: 5s
  - says: {LAST_WORDS}
  - expect: {{state: goodbye, said: Thank you for your visit}}
  - expect: {{played: goodbye}}
  - wait: 2s
"""
"""The number of texts before the wave makes the film show it from the visitor's point of view."""


def film(path: Path) -> None:
    """Play the story in a copy of the shipped project, and film it."""
    with tempfile.TemporaryDirectory() as folder:
        for name in PROJECT:
            copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy2
            copy(ROOT / name, Path(folder) / name)
        (Path(folder) / "behaviors/stories/farewell.yaml").write_text(STORY, encoding="utf-8")
        options = ["--story", "farewell", "--speed", "max", "--video", str(path.resolve()), "--size", f"{SIDE}x{SIDE}"]
        subprocess.run([sys.executable, "-m", "lumen", "run", folder, *options], check=True)


def frames(path: Path) -> tuple[np.ndarray, float]:
    """Return every frame of a film, and its frames per second."""
    reader = imageio_ffmpeg.read_frames(str(path))
    about = next(reader)
    width, height = about["size"]
    pixels = [np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in reader]
    return np.stack(pixels), about["fps"]


def goodbye(pixels: np.ndarray) -> int:
    """Return the number of the frame after the last cut of the film, with which the robot's answer begins."""
    changes = np.abs(np.diff(pixels[:, ::8, ::8].astype(np.int16), axis=0)).mean(axis=(1, 2, 3))
    return int(np.flatnonzero(changes > 15)[-1]) + 1


def convert(path: Path) -> None:
    """Cut the answer and the seconds before it out of a film, add the visitor's words, and write the picture."""
    pixels, rate = frames(path)
    answer = goodbye(pixels)
    first = answer - round(LEAD * rate)
    words = subtitle(LAST_WORDS, VISITOR_COLOUR, SIDE, SIDE)
    shown = []
    for number in range(round(LENGTH * RATE)):
        at = min(first + round(number * rate / RATE), len(pixels) - 1)
        frame = pixels[at].copy()
        if at < answer:
            words.lay_on(frame)
        shown.append(Image.fromarray(frame))
    animated = {"save_all": True, "append_images": shown[1:], "duration": round(1000 / RATE), "loop": 0}
    shown[0].save(PICTURE, quality=72, method=6, **animated)
    print(f"{PICTURE.relative_to(ROOT)}: {len(shown)} frames, {PICTURE.stat().st_size / 1e6:.1f} MB")


def main() -> None:
    parser = argparse.ArgumentParser(description="Make the moving picture of the README.")
    parser.add_argument("--film", type=Path, metavar="FILE.mp4", help="convert this film; make it if it is missing")
    with tempfile.TemporaryDirectory() as folder:
        path = parser.parse_args().film or Path(folder) / "farewell.mp4"
        if not path.exists():
            film(path)
        convert(path)


if __name__ == "__main__":
    main()

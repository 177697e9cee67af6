"""Measure how fast a film is drawn: frames per second of `lumen run --video`, and the cost of a frame at each quality.

`python benchmarks/film.py` films the first seconds of the shipped tour. OpenGL in software is the limit, so the
script also prints the cost of a frame alone, on all cores.
"""

import argparse
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

import imageio_ffmpeg

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.guarded import run_guarded

import lumen
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.rendering import FILM_QUALITY, RenderQuality, RenderState, SceneRenderer
from lumen.project.lending import model_files

QUALITIES = {
    "plain": RenderQuality(),
    "4 samples a pixel": RenderQuality(samples=4),
    "shadows": RenderQuality(shadows=2048),
    "as a film is": FILM_QUALITY,
}


def drawing(width: int, height: int, frames: int) -> dict[str, float]:
    """Return the processor time of a frame at each quality [s], the median of `frames`."""
    project = lumen.load()
    robot = SimulatedRobot(project.body, *model_files(project), stage=project.stage)
    state = RenderState.of(robot.world.model, robot.world.data)
    found = {}
    for name, quality in QUALITIES.items():
        renderer = SceneRenderer(robot.world.model, quality)
        renderer.draw(state, "observer", width, height)
        times = []
        for _ in range(frames):
            began = time.process_time()
            renderer.draw(state, "observer", width, height)
            times.append(time.process_time() - began)
        renderer.close()
        found[name] = statistics.median(times)
    robot.close()
    return found


def filming(width: int, height: int, seconds: float) -> tuple[int, float, float]:
    """Film the first seconds of the tour; return the frames, the wall time, and the time of all processors [s]."""
    with tempfile.TemporaryDirectory() as folder:
        film = Path(folder, "film.mp4")
        wall, cpu = time.perf_counter(), os.times()
        words = ["run", "--story", "visitor", "--speed", "max", "--for", f"{seconds}s", "--video", str(film)]
        run_guarded([sys.executable, "-m", "lumen", *words, "--size", f"{width}x{height}"], check=False)
        took, after = time.perf_counter() - wall, os.times()
        used = sum(getattr(after, kind) - getattr(cpu, kind) for kind in ("children_user", "children_system"))
        frames, _ = imageio_ffmpeg.count_frames_and_secs(str(film))
    return frames, took, used


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--width", type=int, default=1920)
    parser.add_argument("--height", type=int, default=1080)
    parser.add_argument("--seconds", type=float, default=12.0, help="of the tour (default: 12)")
    parser.add_argument("--frames", type=int, default=9, help="drawn for each median (default: 9)")
    options = parser.parse_args()
    costs = drawing(options.width, options.height, options.frames)
    cores = os.cpu_count() or 1
    print(f"{options.width} x {options.height}, {cores} cores, OpenGL in software:")
    for name, cost in costs.items():
        print(f"  {name:<18} {1e3 * cost:5.0f} ms of processor time a frame")
    frames, took, used = filming(options.width, options.height, options.seconds)
    limit = cores / costs["as a film is"]
    print(
        f"a film of {frames} frames: {frames / took:.1f} a second, {1e3 * used / frames:.0f} ms of processor time each"
    )
    print(f"drawing alone, all cores busy with nothing else: {limit:.1f} a second; wanted 6")


if __name__ == "__main__":
    main()

"""Make the pictures of the documentation from the shipped project, with simulated physics.

    python docs/pictures/make.py [tour] [museum] [head] [sides] [motions] [walk] [postures] [fuzzy] [loop] [film]

`tour` shows the shipped story during the dance; `museum` shows the guide of examples/museum at the organ. `head`
makes the paper's Fig. 13 and 14: the top camera's image when the camera first sees the visitor's face, and the image
after the head has turned to it; a cross marks the centre of the image, and a ring marks the face. `sides` shows the
robot from three sides. `motions` makes a sheet of each motion, with the moments that differ most. `walk` shows `walk:
{x: 0.2}` as a row of pictures, and `postures` each way down to the floor and up again. `fuzzy` draws the head
controller, one evaluation of it, and a comparison with the tables as the paper prints them. `loop` draws the closed
loop and prints its numbers. `film` shows four moments of a film of the tour.
"""

import argparse
import io
import math
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import imageio_ffmpeg
import mujoco
import numpy as np
from PIL import Image, ImageDraw, ImageFont

import lumen
from lumen.clock.simulated import SimulatedClock
from lumen.features.simulation.offers import SimulatedRobot, available
from lumen.features.simulation.rendering import RenderQuality, RenderState, SceneRenderer
from lumen.fuzzy import Controller
from lumen.language.commands import Posture, Walk
from lumen.language.motions import MotionDefinition
from lumen.language.projects import Project
from lumen.motion.trajectories import Trajectory
from lumen.ports import Image as Frame
from lumen.ports import Perform, Sense
from lumen.project.formats.plots import controller_sheet, curves_sheet, draw, explained_sheet
from lumen.project.lending import model_files
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.setup import Setup

HERE = Path(__file__).parent
MID_DANCE = 7.0
STRIP = 8
FILM_FRAMES = (30, 110, 190, 225)
"""A title, a close-up, a two-shot and the visitor's point of view."""
WALK = 5.4
ORGAN = 2.1, 0.8
LONG = 14.0
SIDES = {"front": 20.0, "right": -75.0, "back": 205.0}
FLOOR, MIDDLE, DISTANCE = 0.5, 0.27, 1.05


def robot_of(project: Project) -> SimulatedRobot:
    models, hall = model_files(project)
    return SimulatedRobot(project.body, models, hall, stage=project.stage)


def picture(robot: SimulatedRobot, camera: str | mujoco.MjvCamera, width: int, height: int) -> Image.Image:
    """Return the present image of a camera of the hall or of another camera."""
    studio = SceneRenderer(robot.world.model, RenderQuality(shadows=4096, samples=4))
    pixels = studio.draw(RenderState.of(robot.world.model, robot.world.data), camera, width, height)
    studio.close()
    return Image.fromarray(pixels)


def play(project: Project, robot: SimulatedRobot, look: Callable[[Exhibition, float], bool]) -> None:
    """Play the shipped story until `look` has seen enough."""
    chosen = Setup(robot, SimulatedClock(robot.advance), robot)
    show = Exhibition(Plan(project, chosen, story=project.stories[project.story]))
    show.start()
    while not look(show, show.tick()):
        if show.over:
            sys.exit("the story ended before the picture could be taken")
    show.close()


def tour(project: Project) -> None:
    robot = robot_of(project)
    since: list[float] = []

    def look(show: Exhibition, now: float) -> bool:
        if "dance" in show.configuration:
            since.append(now)
        return bool(since) and now > since[0] + 3.0 + MID_DANCE

    play(project, robot, look)
    both = Image.new("RGB", (1280, 480))
    both.paste(picture(robot, "observer", 720, 480), (0, 0))
    both.paste(picture(robot, "close", 560, 480), (720, 0))
    both.save(HERE / "tour.png", optimize=True)


def museum(project: Project) -> None:
    project = lumen.load(Path(project.root) / "examples" / "museum")
    robot = robot_of(project)

    def look(show: Exhibition, now: float) -> bool:
        return "showing" in show.configuration and math.dist(robot.world.data.xpos[robot.world.torso][:2], ORGAN) < 0.2

    play(project, robot, look)
    both = Image.new("RGB", (1280, 480))
    both.paste(picture(robot, "observer", 720, 480), (0, 0))
    both.paste(picture(robot, "close", 560, 480), (720, 0))
    both.save(HERE / "museum.png", optimize=True)


def head(project: Project) -> None:
    robot = robot_of(project)
    camera = project.body.camera
    centre = (camera.width / 2, camera.height / 2)
    taken: list[str] = []

    def look(show: Exhibition, now: float) -> bool:
        face = robot.face()
        if face and not taken and "idle" in show.configuration:
            mark(robot, face, centre).save(HERE / "head_before.png", optimize=True)
            taken.append(f"before: the face is {math.dist(face, centre):.0f} px from the centre")
        if face and taken and math.dist(face, centre) < 10:
            mark(robot, face, centre).save(HERE / "head_after.png", optimize=True)
            taken.append(f"after:  {math.dist(face, centre):.0f} px")
        return len(taken) == 2

    play(project, robot, look)
    print("\n".join(taken))


def mark(robot: SimulatedRobot, face: tuple[float, float], centre: tuple[float, float]) -> Image.Image:
    """Return the top camera's image, with marks at its centre and at the face."""
    frame = robot.read(Sense.IMAGE)
    assert isinstance(frame, Frame)
    image = Image.fromarray(frame.pixels())
    draw = ImageDraw.Draw(image)
    (x, y), (u, v) = centre, face
    draw.line([(x - 8, y), (x + 8, y)], fill="white")
    draw.line([(x, y - 8), (x, y + 8)], fill="white")
    draw.ellipse([(u - 14, v - 14), (u + 14, v + 14)], outline="orange", width=2)
    return image


def near(robot: SimulatedRobot, size: tuple[int, int], label: str = "", around: float = 35.0) -> Image.Image:
    """Return a close picture of the robot, from `around` degrees beside its front, with a text in a corner."""
    world = robot.world
    camera = mujoco.MjvCamera()
    camera.lookat[:] = (*world.data.xpos[world.torso][:2], FLOOR + MIDDLE)
    camera.distance, camera.azimuth, camera.elevation = DISTANCE, 180.0 + around, -12.0
    shot = picture(robot, camera, *size)
    font = ImageFont.load_default(size=15)
    ImageDraw.Draw(shot).text((8, 5), label, font=font, fill="white", stroke_width=2, stroke_fill="black")
    return shot


def sheet(shots: Sequence[Image.Image], columns: int) -> Image.Image:
    """Arrange pictures of one size in rows."""
    width, height = shots[0].size
    whole = Image.new("RGB", (width * columns, height * math.ceil(len(shots) / columns)))
    for i, shot in enumerate(shots):
        whole.paste(shot, (width * (i % columns), height * (i // columns)))
    return whole


def sides(project: Project) -> None:
    """Show the robot from its front, from its left and from behind."""
    robot = robot_of(project)
    robot.advance(1.0)
    shots = [near(robot, (360, 420), label, around) for label, around in SIDES.items()]
    sheet(shots, len(shots)).save(HERE / "sides.png", optimize=True)
    robot.close()


def moments(project: Project, motion: MotionDefinition, count: int) -> list[float]:
    """Return the times [s] of the poses of a motion that differ most from each other."""
    course = Trajectory(motion, project.body.postures[motion.start or "Stand"])
    times = np.arange(0.1, motion.duration, 0.1)
    poses = np.array([[course.sample(t).get(name, 0.0) for name in motion.tracks] for t in times])
    chosen = [0]
    while len(chosen) < count:
        apart = np.array([np.abs(poses - poses[i]).sum(axis=1) + 0.3 * np.abs(times - times[i]) for i in chosen])
        chosen.append(int(apart.min(axis=0).argmax()))
    return sorted(float(times[i]) for i in chosen)


def motions(project: Project) -> None:
    for name, motion in project.motions.items():
        robot, shots, before = robot_of(project), [], 0.0
        perform(robot, Posture(motion.start or "Stand", 1.0))
        robot.start("c", Perform(motion))
        for at in moments(project, motion, 12 if motion.duration > LONG else 6):
            robot.advance(at - before)
            shots.append(near(robot, (250, 300), f"{at:.1f} s"))
            before = at
        sheet(shots, 6).save(HERE / f"motion_{name}.png", optimize=True)
        robot.close()


def walk(project: Project) -> None:
    robot, shots = robot_of(project), []
    robot.start("c1", Walk(-0.15))
    robot.advance(WALK)
    robot.start("c2", Walk(0.2))
    for _ in range(STRIP):
        shots.append(picture(robot, "close", 200, 260))
        robot.advance(WALK / (STRIP - 1))
    sheet(shots, STRIP).save(HERE / "walk.png", optimize=True)
    robot.close()


def postures(project: Project) -> None:
    """Make a row for each passage between two postures: the robot before, during and after it."""
    shots, count = [], 7
    for passage in project.body.passages:
        robot = robot_of(project)
        perform(robot, Posture(passage.start, 1.0))
        robot.start("c", Posture(passage.end, 1.0))
        for column in range(count):
            label = f"{column * (passage.duration + 0.4) / (count - 1):.1f} s"
            label = label if column else f"{passage.start} to {passage.end}"
            shots.append(near(robot, (220, 180), label, SIDES["right"]))
            robot.advance((passage.duration + 0.4) / (count - 1))
        robot.close()
    sheet(shots, count).save(HERE / "postures.png", optimize=True)


def perform(robot: SimulatedRobot, command: Posture) -> None:
    """Run a command to its end."""
    robot.start("p", command)
    while not any(event.name == "done.command.p" for event in robot.poll()):
        robot.advance(0.1)


def fuzzy(project: Project) -> None:
    """Draw the shipped controller, its output for a face on the left, and a comparison with the printed tables."""
    head = Controller.load(Path(project.root) / "fuzzy/head.yaml")
    printed = Controller.load(Path(project.root) / "examples/erratum/fuzzy/head.yaml")
    at = explained_sheet(head, head.explain({"FaceXLoc": 80.0, "FaceYLoc": 120.0}))
    versus = curves_sheet("Tables 1 and 2", {"as printed": printed, "put right": head})
    for name, sheet in (("head", controller_sheet(head)), ("head_at", at), ("erratum", versus)):
        drawn = Image.open(io.BytesIO(draw(sheet, ".png"))).convert("RGB").quantize(32)
        drawn.save(HERE / f"fuzzy_{name}.png", optimize=True)


def loop(project: Project) -> None:
    script = Path(project.root) / "benchmarks" / "head.py"
    subprocess.run([sys.executable, script, "--plot", HERE / "head_loop.png"], check=True)


def film(project: Project) -> None:
    """Film the beginning of the tour, and make a picture of four frames."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "tour.mp4")
        size = 960, 540
        words = ["run", "--story", "visitor", "--speed", "max", "--for", "14s", "--video", str(file)]
        command = [sys.executable, "-m", "lumen", *words, "--size", "x".join(map(str, size))]
        subprocess.run(command, check=False)  # 1: the story was not played to its end
        frames = imageio_ffmpeg.read_frames(str(file))
        next(frames)
        shots = [Image.frombytes("RGB", size, frame) for i, frame in enumerate(frames) if i in FILM_FRAMES]
    sheet([shot.resize((640, 360), Image.Resampling.LANCZOS) for shot in shots], 2).save(
        HERE / "film.png", optimize=True
    )


PICTURES = {
    "fuzzy": fuzzy,
    "loop": loop,
    "film": film,
    "tour": tour,
    "museum": museum,
    "head": head,
    "sides": sides,
    "motions": motions,
    "walk": walk,
    "postures": postures,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", nargs="*", choices=[*PICTURES, []], help="which; default: all")
    names = parser.parse_args().pictures or list(PICTURES)
    if reason := available():
        sys.exit(reason)
    project = lumen.load(HERE.parent.parent)
    for name in names:
        PICTURES[name](project)
        print(f"{name}: done")


if __name__ == "__main__":
    main()

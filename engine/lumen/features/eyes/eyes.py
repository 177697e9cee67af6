"""Examines the camera's images, and publishes the faces and people found."""

import time
from collections.abc import Callable, Mapping
from math import degrees, tan
from pathlib import Path
from typing import Any, Self

from lumen.errors import ModuleError
from lumen.features.eyes.detector import Box, PersonDetector
from lumen.features.eyes.gallery import MAX_PICTURES_PER_NAME, FaceGallery
from lumen.features.eyes.opencv import opencv
from lumen.features.eyes.pictures import Frame, check_size, frame_of
from lumen.features.eyes.window import Window
from lumen.language.modules import EYES
from lumen.language.people import name_key
from lumen.language.projects import Project
from lumen.language.routes import IMAGE
from lumen.ports import Bus, Message, MessageHandler
from lumen.run.forgetting.added import Forgetting, ForgottenPlace
from lumen.run.forgetting.files import attempt
from lumen.run.module import DAY, KEEP_DAYS, Module

ROBOT_CAMERA = "robot"
"""The value of `camera` for the robot's own camera."""


class VideoSource:
    """The frames of a webcam, given by number, or of a video file in `root`. Raises ModuleError if opening fails."""

    def __init__(self, camera: int | str, root: Path) -> None:
        cv2 = self._cv2 = opencv()
        self.live = isinstance(camera, int)
        what: Any = camera if isinstance(camera, int) else str(root / camera)
        if not self.live and not Path(what).is_file():
            raise ModuleError(
                f"there is no video {what}: set `camera` to `robot`, the number of a webcam, or a video file"
            )
        self._what = f"webcam {camera}" if self.live else what
        self._capture = cv2.VideoCapture(what)
        if not self._capture.isOpened():
            self._capture.release()
            raise ModuleError(
                f"{self._what} cannot be opened" + ("" if self.live else ": its video format is not supported")
            )
        rate = self._capture.get(cv2.CAP_PROP_FPS)
        self.period = 1.0 / rate if 1.0 <= rate <= 240.0 else 1.0 / 30.0

    def read(self) -> Frame | None:
        """Return the next frame, without a time on the robot's clock; None at the end.

        Raises ModuleError if the frame's size is out of range.
        """
        there, pixels = self._capture.read()
        if not there:
            return None
        check_size(pixels.shape[1], pixels.shape[0])
        return Frame(self._cv2.cvtColor(pixels, self._cv2.COLOR_BGR2GRAY), None)

    def close(self) -> None:
        """Release the camera or file."""
        self._capture.release()


FACES_FILE = "faces.npz"
LOOK_INTERVAL = 0.1
"""The default time between two examined images [s]."""
PEOPLE_INTERVAL = 1.0
"""The minimum time between two searches for people [s], which are slower than searches for faces."""
NAME_INTERVAL = 2.0
"""The minimum time between two messages with the same recognised name, while the face stays visible [s]."""
NEW_VISITOR_GAP = 1.0
"""The time without a face after which the next face counts as a new visitor's [s]."""
UNKNOWN, UNRECOGNISED, FAILED = "unknown", "face unrecognized", "error cvException"
"""The names that the modules of 2015 published for a face without a name, for no face, and for an error of OpenCV."""
FACE_WIDTH = 0.16
"""The default real width of the detector's box around an adult's face [m]."""
MAX_NAME_CHARACTERS = 60
"""The maximum number of characters in the name of a face."""


class Eyes(Module):
    """The visual module. After a name on `lumen.visual.command`, the next faces seen are learnt under this name.

    `file` keeps the named faces; with None, they are kept in this process only. Raises ModuleError if OpenCV, its
    models or the camera are missing, if `file` is unusable, or if the window's port is taken.
    """

    name = EYES

    @classmethod
    def make(cls, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Self:
        """Make the module with its faces in `folder`, or without a file if `folder` is None."""
        return cls(project, bus, tell, folder and folder / FACES_FILE)

    def __init__(
        self,
        project: Project,
        bus: Bus,
        tell: Callable[[str], None],
        file: Path | None,
        clock: Callable[[], float] = time.time,
    ) -> None:
        super().__init__(project, bus, tell)
        options = self.settings.options
        self._clock, self._detector, self._gallery = clock, PersonDetector(), FaceGallery(file, clock)
        camera = options.get("camera", ROBOT_CAMERA)
        self._source = None if camera == ROBOT_CAMERA else VideoSource(camera, Path(project.root))
        self._every, self._keep = (
            float(options.get("every", LOOK_INTERVAL)),
            float(options.get("keep", KEEP_DAYS)) * DAY,
        )
        self._looked = self._sought = self._seen = self._named = float("-inf")
        self._learning, self._left = "", 0
        self._who, self._expired = "", 0.0
        self._people: list[Box] = []
        self._head = ""
        self._window = Window(options["window"]) if "window" in options else None
        if self._window:
            self._tell(
                f"see their picture at {self._window.address}"
            )  # on this terminal only, since the address is a secret

    def hears(self) -> Mapping[str, MessageHandler]:
        """Return the message handlers by route."""
        heard: dict[str, MessageHandler] = {"visual_command": self._enrol, "forgotten": self._forget}
        if self._window:
            heard["joint"] = self._joints
        return heard if self._source else {str(self.settings.options.get("images", IMAGE)): self._image, **heard}

    def idle(self) -> float | None:
        """Examine the next frame of the module's own source, if any, and delete expired faces hourly.

        Return the time until the next call [s].
        """
        if self._clock() - self._expired > 3_600.0:
            self._expired = self._clock()
            self._guarded(lambda: self._gallery.expire(self._clock() - self._keep))
        if self._source is None:
            return 3_600.0
        self._guarded(self._watch)
        return self._source.period if self._source else 3_600.0

    def end(self) -> None:
        """Close the source and the window."""
        if self._source:
            self._source.close()
        if self._window:
            self._window.close()

    def look(self, frame: Frame, now: float) -> None:
        """Publish the nearest face and, every `PEOPLE_INTERVAL`, the largest person in a frame taken at `now` [s].

        Raises ModuleError if OpenCV fails.
        """
        try:
            faces = self._detector.faces(frame.grey)
            if faces:
                self._face(frame, faces[0], now)
            if now - self._sought >= PEOPLE_INTERVAL:
                self._sought = now
                self._people = self._detector.people(frame.grey, faces)
                for person in self._people[:1]:
                    x, y = self._place(frame, person)
                    self.publish("human", {"x": round(x), "y": round(y), **_when(frame)})
            self._show(frame, faces[:1])
        except Exception as error:
            if type(error).__module__ != "cv2":
                raise
            self.publish("recognised", {"name": FAILED, **_when(frame)})
            raise ModuleError(f"OpenCV failed on an image: {str(error).splitlines()[0][:200]}") from None
        self.well()

    def _image(self, message: Message) -> None:
        now = message.body.get("time") if isinstance(message.body, dict) else None
        now = float(now) if isinstance(now, int | float) else time.monotonic()
        if 0.0 <= now - self._looked < self._every - 1e-6:
            return
        self._looked = now
        self.look(frame_of(message.body), now)

    def _watch(self) -> None:
        assert self._source
        frame = self._source.read()
        if frame is None:
            self._source.close()
            self._source = None
            raise ModuleError("the video has ended: the eyes see nothing now")
        now = time.monotonic()
        if now - self._looked >= self._every:
            self._looked = now
            self.look(frame, now)

    def _face(self, frame: Frame, face: Box, now: float) -> None:
        x, y = self._place(frame, face)
        self.publish("face", {"x": round(x), "y": round(y), **self._distance(frame, face), **_when(frame)})
        self.publish("face_tracking", {"x": x, "y": y, **_when(frame)})
        if self._left:
            self._learn(frame, face)
        who = self._gallery.who(frame.grey, face) or UNKNOWN
        if who != self._who or now - self._seen > NEW_VISITOR_GAP or now - self._named >= NAME_INTERVAL:
            self._who, self._named = who, now
            self.publish("recognised", {"name": who, **_when(frame)})
        self._seen = now

    def _joints(self, message: Message) -> None:
        """Record the head's angles, which the window shows."""
        match message.body:
            case {"name": list(names), "angle": list(angles)}:
                found = {n: a for n, a in zip(map(str, names), angles, strict=False) if isinstance(a, int | float)}
                yaw, pitch = map(degrees, self.project.body.roles.head_angles(found))
                self._head = f"head {yaw:+.1f} {pitch:+.1f} deg"

    def _show(self, frame: Frame, faces: list[Box]) -> None:
        if self._window:
            where = [f"face {x:.0f} {y:.0f}: {self._who}" for x, y in (self._place(frame, face) for face in faces)]
            self._window.show(frame.grey, faces, self._people, "   ".join([*where, self._head]).strip())

    def _place(self, frame: Frame, box: Box) -> tuple[float, float]:
        """Return a box's centre, in pixels of the robot's camera, or of the frame if the camera is unknown."""
        camera, (height, width) = self.project.body.camera, frame.grey.shape
        x, y = box.centre
        if camera is None:
            return x, y
        x, y = x * camera.width / width, y * camera.height / height
        return min(max(x, 0.0), float(camera.width)), min(max(y, 0.0), float(camera.height))

    def _distance(self, frame: Frame, face: Box) -> dict[str, float]:
        """Return the face's `distance` [m], from its width in the image; empty if the body's camera is unknown."""
        camera = self.project.body.camera
        if camera is None:
            return {}
        share = 2 * tan(camera.horizontal_fov / 2) * face.width / frame.grey.shape[1]
        return {"distance": round(self.settings.options.get("face_width", FACE_WIDTH) / share, 2)}

    def _learn(self, frame: Frame, face: Box) -> None:
        self._gallery.enrol(self._learning, frame.grey, face)
        self._left -= 1
        if not self._left:
            self._tell(f"has learnt the face of {self._learning}")

    def _enrol(self, message: Message) -> None:
        """Start to learn the next faces under the name in the message, which is a bare text, as in 2015."""
        name = message.body.strip() if isinstance(message.body, str) else ""
        if not name or len(name) > MAX_NAME_CHARACTERS or not name.isprintable():
            raise ModuleError(f"a message on {message.key} needs a `name` of at most {MAX_NAME_CHARACTERS} characters")
        self._learning, self._left = name, MAX_PICTURES_PER_NAME

    def _forget(self, message: Message) -> None:
        """Delete a forgotten person's faces, and stop learning them."""
        match message.body:
            case {"name": str(name)} if name_key(name):
                if name_key(self._learning) == name_key(name):
                    self._learning, self._left = "", 0
                if name_key(self._who) == name_key(name):
                    self._who = ""
                self._gallery.forget(name)

    def _guarded(self, work: Callable[[], Any]) -> None:
        try:
            work()
        except ModuleError as error:
            self.tell(str(error))


def _when(frame: Frame) -> dict[str, float]:
    return {} if frame.time is None else {"time": frame.time}


def forget_faces(folder: Path, name: str, found: Forgetting) -> None:
    """Delete the pictures of a person's face in an exhibition's home `folder`, and record the result in `found`."""

    def work() -> None:
        if gone := FaceGallery(file, time.time).forget(name):
            found.pictures += gone
            found.deleted.append(ForgottenPlace(file.name, f"pictures: {gone}"))

    file = folder / FACES_FILE
    attempt(found, file, work)

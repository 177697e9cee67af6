"""A webcam or a video file in place of the robot's camera."""

from pathlib import Path
from typing import Any

from lumen.errors import ModuleError
from lumen.features.eyes.opencv import opencv
from lumen.features.eyes.pictures import Frame, check_size

ROBOT_CAMERA = "robot"
"""The value of `camera` that stands for the robot's own."""


class VideoSource:
    """Frames of the webcam of that number, or of a video file in `root`; `read` gives the next one, None at the end.

    Raises ModuleError where there is no such camera or file.
    """

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
        """The next frame; its time is unknown to the robot's clock."""
        there, pixels = self._capture.read()
        if not there:
            return None
        check_size(pixels.shape[1], pixels.shape[0])
        return Frame(self._cv2.cvtColor(pixels, self._cv2.COLOR_BGR2GRAY), None)

    def close(self) -> None:
        self._capture.release()

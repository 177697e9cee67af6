"""Finds faces and people in pictures with the models that OpenCV's package includes."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from lumen.errors import ModuleError
from lumen.features.eyes.opencv import INSTALL_EYES, opencv

if TYPE_CHECKING:
    from lumen.features.eyes.pictures import Grey

FACE_CASCADE = "haarcascade_frontalface_alt.xml"
"""R. Lienhart's stump-based Haar cascade: of the package's cascades, its box fits a face most tightly."""
SEARCH_WIDTH = 320
"""The width to which pictures are scaled [px]: a face at 2 m is then 22 px wide, and detection takes 50 ms."""
SCALE_STEP, MIN_NEIGHBOURS, MIN_FACE_SIZE = 1.05, 3, 20
"""The cascade's scale factor, the number of overlapping hits that make a face, and the smallest face size [px]."""
RIM_WIDTH = 30
"""The extension of pictures beyond their edges [px], which helps to find faces with a cut-off forehead."""
MIN_PERSON_WEIGHT = 0.4
"""The minimum distance of a person's hit from the classifier's separating plane."""


class Box(NamedTuple):
    """A rectangle in a picture [px], from its upper left corner."""

    x: float
    y: float
    width: float
    height: float

    @property
    def centre(self) -> tuple[float, float]:
        """The rectangle's centre [px]."""
        return self.x + self.width / 2, self.y + self.height / 2

    def holds(self, place: tuple[float, float]) -> bool:
        """Return True if a point [px] is in the rectangle."""
        return 0.0 <= place[0] - self.x <= self.width and 0.0 <= place[1] - self.y <= self.height


class PersonDetector:
    """Finds faces and people. Raises ModuleError if the models can't be loaded."""

    def __init__(self, cascade: Path | None = None) -> None:
        cv2 = self._cv2 = opencv()
        file = cascade or Path(cv2.data.haarcascades) / FACE_CASCADE
        if not file.is_file():
            raise ModuleError(f"the face model {file} is missing: {INSTALL_EYES}; OpenCV 5 no longer includes it")
        self._faces = cv2.CascadeClassifier()
        try:
            loaded = self._faces.load(str(file))
        except cv2.error:
            loaded = False
        if not loaded:
            raise ModuleError(f"the face model {file} cannot be loaded: {INSTALL_EYES} again")
        self._people = cv2.HOGDescriptor()
        self._people.setSVMDetector(cv2.HOGDescriptor_getDefaultPeopleDetector())

    def faces(self, grey: "Grey") -> list[Box]:
        """Return the boxes of faces [px], the largest, and so probably the nearest, first."""
        small, zoom = self._small(grey)
        framed = self._cv2.copyMakeBorder(small, RIM_WIDTH, RIM_WIDTH, RIM_WIDTH, RIM_WIDTH, self._cv2.BORDER_REPLICATE)
        found = self._faces.detectMultiScale(framed, SCALE_STEP, MIN_NEIGHBOURS, minSize=(MIN_FACE_SIZE, MIN_FACE_SIZE))
        return _sorted([(x - RIM_WIDTH, y - RIM_WIDTH, w, h) for x, y, w, h in found], zoom)

    def people(self, grey: "Grey", faces: Sequence[Box] = ()) -> list[Box]:
        """Return the boxes of people visible from head to foot (Dalal and Triggs, CVPR 2005), or known from `faces`.

        The largest come first. A person near the robot is not fully visible, so the box is derived from the face.
        """
        whole = self._whole(grey)
        near = [_below(face, *grey.shape) for face in faces if not any(box.holds(face.centre) for box in whole)]
        return sorted([*whole, *near], key=lambda box: -box.width * box.height)

    def _whole(self, grey: "Grey") -> list[Box]:
        small, zoom = self._small(grey)
        if small.shape[0] < 128 or small.shape[1] < 64:
            return []
        found, weights = self._people.detectMultiScale(small, winStride=(8, 8), scale=1.05)
        return _sorted([box for box, weight in zip(found, weights, strict=True) if weight > MIN_PERSON_WEIGHT], zoom)

    def _small(self, grey: "Grey") -> tuple[Any, float]:
        """Return the picture scaled to the search width, and the factor that converts its pixels to the original's."""
        height, width = grey.shape
        if width == SEARCH_WIDTH:
            return grey, 1.0
        zoom = width / SEARCH_WIDTH
        return self._cv2.resize(
            grey, (SEARCH_WIDTH, max(1, round(height / zoom))), interpolation=self._cv2.INTER_AREA
        ), zoom


def _below(face: Box, height: int, width: int) -> Box:
    """Return the visible box of the person with this face: three face widths wide and seven high."""
    left, top = max(0.0, face.x - face.width), max(0.0, face.y - face.height / 2)
    right, bottom = min(float(width), face.x + 2 * face.width), min(float(height), top + 7 * face.height)
    return Box(left, top, right - left, bottom - top)


def _sorted(found: Any, zoom: float) -> list[Box]:
    boxes = [Box(*(float(number) * zoom for number in box)) for box in found]
    return sorted(boxes, key=lambda box: -box.width * box.height)

"""Recognises faces by comparing their local binary patterns with those of faces learnt under a name."""

import io
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lumen.errors import ModuleError
from lumen.features.eyes.detector import Box
from lumen.features.eyes.opencv import opencv
from lumen.language.people import name_key
from lumen.upkeep.own_folders import private_folder, write_private

if TYPE_CHECKING:
    from lumen.features.eyes.pictures import Grey

FACE_SIZE = 96
"""The width and height at which faces are compared [px]."""
MAX_PICTURES_PER_NAME = 8
"""The maximum number of face pictures kept for a name; another picture replaces the oldest."""
MAX_DISTANCE = 70.0
"""The largest chi-square distance between the patterns' histograms at which a face counts as a known face."""
MAX_PICTURES = 500
"""The maximum number of pictures of all names; beyond it, no new face is learnt."""


class FaceGallery:
    """The named faces, kept in `file`, or in this process only if `file` is None. Only the owner can read the file.

    Since these are pictures of people, `forget` deletes a name's pictures, and `expire` deletes pictures made before a
    time. Raises ModuleError if the file is unusable.
    """

    def __init__(self, file: Path | None, clock: Callable[[], float]) -> None:
        self._cv2, self._file, self._clock = opencv(), file, clock
        self._faces: list[tuple[str, float, Any]] = []
        self._model: Any = None
        self._unsaved = False
        """True if the file could not be written: it may contain deleted pictures, and the next deletion writes it."""
        if file and file.exists():
            self._faces = list(_read(file))
            self._train()

    @property
    def names(self) -> list[str]:
        """The known names, sorted."""
        return sorted({name for name, _, _ in self._faces})

    def enrol(self, name: str, grey: "Grey", face: Box) -> int:
        """Store this face under a name; return the name's number of pictures.

        Raises ModuleError if the gallery is full or the file can't be written.
        """
        key = name_key(name)
        mine = [i for i, (other, _, _) in enumerate(self._faces) if name_key(other) == key]
        replaced = mine[:1] if len(mine) >= MAX_PICTURES_PER_NAME else []
        if len(self._faces) - len(replaced) >= MAX_PICTURES:
            raise ModuleError(
                f"the gallery is full ({MAX_PICTURES} pictures of faces): forget a visitor, then learn `{name}` again"
            )
        for oldest in replaced:
            del self._faces[oldest]
        self._faces.append((name, self._clock(), self._cut(grey, face)))
        self._save()
        return sum(name_key(other) == key for other, _, _ in self._faces)

    def who(self, grey: "Grey", face: Box) -> str:
        """Return the face's name; empty if the face is unknown."""
        if self._model is None:
            return ""
        label, distance = self._model.predict(self._cut(grey, face))
        return self.names[label] if distance <= MAX_DISTANCE else ""

    def forget(self, name: str) -> int:
        """Delete a name's pictures, whatever its case, spacing or form in Unicode; return their number."""
        return self._keep([face for face in self._faces if name_key(face[0]) != name_key(name)])

    def expire(self, before: float) -> int:
        """Delete the pictures made before the time `before` [s since 1970]; return their number."""
        return self._keep([face for face in self._faces if face[1] >= before])

    def _keep(self, faces: list[tuple[str, float, Any]]) -> int:
        gone = len(self._faces) - len(faces)
        if gone or self._unsaved:
            self._faces = faces
            self._save()
        return gone

    def _cut(self, grey: "Grey", face: Box) -> Any:
        height, width = grey.shape
        left, top = max(0, round(face.x)), max(0, round(face.y))
        right, bottom = min(width, round(face.x + face.width)), min(height, round(face.y + face.height))
        cut = grey[top : max(bottom, top + 1), left : max(right, left + 1)]
        return self._cv2.equalizeHist(self._cv2.resize(cut, (FACE_SIZE, FACE_SIZE), interpolation=self._cv2.INTER_AREA))

    def _train(self) -> None:
        import numpy as np

        self._model = None
        if self._faces:
            names = self.names
            self._model = self._cv2.face.LBPHFaceRecognizer_create()
            labels = np.array([names.index(name) for name, _, _ in self._faces])
            self._model.train([face for _, _, face in self._faces], labels)

    def _save(self) -> None:
        """Train with the present faces, and replace the file. Raises ModuleError if the file can't be written."""
        self._train()
        if self._file is None:
            return
        self._unsaved = True
        import numpy as np

        data = io.BytesIO()
        names = np.array([name for name, _, _ in self._faces], dtype=np.str_)
        times = np.array([time for _, time, _ in self._faces], dtype=np.float64)
        faces = np.array([face for _, _, face in self._faces], dtype=np.uint8).reshape(-1, FACE_SIZE, FACE_SIZE)
        np.savez_compressed(data, names=names, times=times, faces=faces)
        try:
            private_folder(self._file.parent)
            write_private(self._file, data.getvalue())
        except OSError as error:
            raise ModuleError(f"{self._file} cannot be written: {error.strerror}") from None
        self._unsaved = False


def _read(file: Path) -> Iterable[tuple[str, float, Any]]:
    import numpy as np

    try:
        with np.load(file, allow_pickle=False) as data:
            names, times, faces = data["names"].tolist(), data["times"].tolist(), data["faces"]
        if faces.shape != (len(names), FACE_SIZE, FACE_SIZE) or faces.dtype != np.uint8 or len(times) != len(names):
            raise ValueError
    except Exception:  # zip, numpy and the disk raise different errors for damaged files
        raise ModuleError(f"{file} contains no faces or is damaged: move it away, then teach the names again") from None
    return zip(map(str, names), map(float, times), faces, strict=True)

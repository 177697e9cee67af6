"""The projects with open files, including unsaved texts."""

from pathlib import Path

from lumen.errors import UsageError
from lumen.features.editor.analysis import Analysis
from lumen.project.files import composed, read_files
from lumen.project.project_folders import MAIN_FILE, kind_of


class OpenProjects:
    """The unsaved texts by path, and the projects' analyses, each kept until one of the project's files changes."""

    def __init__(self) -> None:
        self._texts: dict[Path, str] = {}
        self._analyses: dict[Path, Analysis] = {}
        self._before: dict[Path, Analysis] = {}

    def write(self, path: Path, text: str) -> None:
        """Set the current text of an open file."""
        self._texts[path] = text
        self.forget(path)

    def close(self, path: Path) -> None:
        """Discard the unsaved text of a closed file; from now on the file on disk counts."""
        self._texts.pop(path, None)
        self.forget(path)

    def forget(self, path: Path) -> None:
        """Mark the analysis of a changed file's project as outdated; the next analysis is based on it."""
        if root := root_of(path):
            last = self._analyses.pop(root, None)
            if last is not None:
                self._before[root] = last

    def analysis(self, root: Path) -> Analysis:
        """Return the analysis of the project in the folder `root`, including unsaved texts."""
        if root not in self._analyses:
            files = read_files(root)
            for path, text in self._texts.items():
                file = _file(path, root)
                if file and (kind_of(file) or file in files):
                    files[file] = text.encode("utf-8", "surrogatepass")
            self._analyses[root] = Analysis(root, files, self._before.get(root))
        return self._analyses[root]

    def roots(self) -> list[Path]:
        """Return the folders of projects with an open file."""
        return list(dict.fromkeys(root for path in list(self._texts) if (root := root_of(path))))

    def at(self, path: Path) -> tuple[Analysis, str]:
        """Return the analysis of a file's project, and the file's path in the project.

        Raises UsageError if the file belongs to no project.
        """
        root = root_of(path)
        if root is None:
            raise UsageError(f"{path} is in no project: no folder above it has a {MAIN_FILE}")
        return self.analysis(root), _file(path, root)


def root_of(path: Path) -> Path | None:
    """Return the nearest folder above a file that contains a lumen.yaml; None if there is none."""
    return next((folder for folder in path.parents if (folder / MAIN_FILE).is_file()), None)


def _file(path: Path, root: Path) -> str:
    return composed(path.relative_to(root).as_posix()) if path.is_relative_to(root) else ""

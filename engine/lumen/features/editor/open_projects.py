"""The projects whose files an editor has open, with what is written in them and not yet saved."""

from pathlib import Path

from lumen.errors import UsageError
from lumen.features.editor.analysis import Analysis
from lumen.project.files import composed, read_files
from lumen.project.project_folders import MAIN_FILE, kind_of


class OpenProjects:
    """Knows the unsaved texts by path; an analysis of a project lasts until something in it changes."""

    def __init__(self) -> None:
        self._texts: dict[Path, str] = {}
        self._analyses: dict[Path, Analysis] = {}
        self._before: dict[Path, Analysis] = {}

    def write(self, path: Path, text: str) -> None:
        """What stands in an open file now."""
        self._texts[path] = text
        self.forget(path)

    def close(self, path: Path) -> None:
        """The file is not edited any more: what is on disk counts again."""
        self._texts.pop(path, None)
        self.forget(path)

    def forget(self, path: Path) -> None:
        """Something has happened to a file."""
        if root := root_of(path):
            last = self._analyses.pop(root, None)
            if last is not None:
                self._before[root] = last

    def analysis(self, root: Path) -> Analysis:
        """The project in that folder, as it is now."""
        if root not in self._analyses:
            files = read_files(root)
            for path, text in self._texts.items():
                file = _file(path, root)
                if file and (kind_of(file) or file in files):
                    files[file] = text.encode("utf-8", "surrogatepass")
            self._analyses[root] = Analysis(root, files, self._before.get(root))
        return self._analyses[root]

    def roots(self) -> list[Path]:
        """The folders of the projects of which a file is open."""
        return list(dict.fromkeys(root for path in list(self._texts) if (root := root_of(path))))

    def at(self, path: Path) -> tuple[Analysis, str]:
        """The project that a file belongs to, and its name in it. Raises UsageError where it belongs to none."""
        root = root_of(path)
        if root is None:
            raise UsageError(f"{path} is in no project: no folder above it has a {MAIN_FILE}")
        return self.analysis(root), _file(path, root)


def root_of(path: Path) -> Path | None:
    """The nearest folder above a file that holds a lumen.yaml."""
    return next((folder for folder in path.parents if (folder / MAIN_FILE).is_file()), None)


def _file(path: Path, root: Path) -> str:
    return composed(path.relative_to(root).as_posix()) if path.is_relative_to(root) else ""

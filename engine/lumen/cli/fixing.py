"""`lumen lint --fix` and `--diff`: make or show repairs that need no decision."""

import difflib
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from lumen.cli.render.terminal_text import clean, counted
from lumen.cli.terminal import paint
from lumen.errors import UsageError
from lumen.language.text_lines import lines_of
from lumen.lint.repairs import Repair, repaired
from lumen.project.files import on_disk
from lumen.run.linting.findings import Findings
from lumen.run.linting.targets import LintTarget, Wanted, checked
from lumen.upkeep.replacing import replace_file


def repair(what: LintTarget, wanted: Wanted) -> tuple[Mapping[str, bytes], Mapping[str, bytes], list[Repair]]:
    """Return the files of a project before and after the repair, and the repairs that were made.

    Faults of repairs that installed packages provide are printed on standard error, each once.
    """
    before, faults = what.files(), set[str]()
    after, done = repaired(
        before,
        lambda files: checked(what.root, files),
        lambda d: wanted(d) and what.shown(d),
        lambda error: faults.add(str(error)),
    )
    for fault in sorted(faults):
        print(clean(fault), file=sys.stderr)
    return before, after, done


def diff(root: Path, before: Mapping[str, bytes], after: Mapping[str, bytes], on: bool) -> Iterator[str]:
    """Yield the lines of a unified diff between the files before and after a repair; `on` adds colours."""
    for file in (file for file in after if after[file] != before[file]):
        name = Findings((), {}, str(root)).name(file)
        old, new = (lines_of(files[file].decode("utf-8", "replace").rstrip("\r\n")) for files in (before, after))
        for line in difflib.unified_diff(old, new, name, name, lineterm=""):
            yield paint(clean(line), *_style(line), on=on)


def _style(line: str) -> tuple[str, ...]:
    if line.startswith(("---", "+++")):
        return ("bold",)
    return {"+": ("green",), "-": ("red",), "@": ("cyan",)}.get(line[:1], ())


def write(root: Path, before: Mapping[str, bytes], after: Mapping[str, bytes]) -> None:
    """Replace the files that changed, each atomically and with its old permissions.

    Raises UsageError if a file can't be written, or has changed on disk since it was read.
    """
    for file in (file for file in after if after[file] != before[file]):
        path = on_disk(root, file).resolve()
        try:
            if path.read_bytes() != before[file]:
                raise UsageError(f"{path} has changed in the meantime and was not rewritten: run the command again")
            replace_file(path, after[file])
        except OSError as error:
            raise UsageError(f"can't write {path}: {(error.strerror or str(error)).lower()}") from None


def tell(done: Sequence[Repair], names: Findings) -> None:
    """Print on standard error which findings were repaired."""
    for diagnostic, fix in done:
        where = f"{names.name(diagnostic.place.file)}:{diagnostic.place.line}"
        print(clean(f"fixed {where} [{diagnostic.code}] {fix.title}"), file=sys.stderr)
    print(f"{counted(len(done), 'finding')} fixed", file=sys.stderr)

"""Writes docs/rules/ from the pages of the rules: `python scripts/rule_pages.py`.

Each example is laid over a small valid project and linted; the docs show lint's output for the wrong ones.
"""

import re
import sys
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from written_distribution import on_path, write_distribution

from lumen.features.simulation.trials.playing import played
from lumen.language.diagnostics import Diagnostic
from lumen.lint import check_files
from lumen.lint.codes import codes, families
from lumen.lint.pages import Example, Page, page
from lumen.project.files import Unreadable, read_files
from lumen.run.linting.findings import Findings
from lumen.run.reload.against import against

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs/rules"
BASE = ROOT / "tests/lint/pages/base"

INSTALLED = "installed"
"""The note at modules of an installed distribution."""
PHYSICS, OTHERS = "physics", 1
"""The note at examples about the shipped robot in simulation, and the number of robots that play them besides it."""

_BLOCK = re.compile(r"^(?=[^\s#])", re.MULTILINE)


def laid(base: Mapping[str, bytes], sheets: Iterable[Example]) -> dict[str, bytes]:
    """Return the files of the small project with those of an example laid over them."""
    files = dict(base)
    for sheet in sheets:
        if sheet.language == "python":
            continue
        if sheet.note == "folder":
            files[sheet.file] = Unreadable(b"it is a folder")
        elif sheet.note == "none":
            files.pop(sheet.file, None)
        else:
            text = sheet.text + _kept(base.get(sheet.file, b"").decode(), sheet)
            files[sheet.file] = text.encode("latin-1" if sheet.note == "latin-1" else "utf-8")
    return dict(sorted(files.items()))


def _kept(below: str, sheet: Example) -> str:
    """Return the blocks of a YAML file whose keys an example does not change."""
    if sheet.language != "yaml" or sheet.note:
        return ""
    given = {block.split(":")[0] for block in _BLOCK.split(sheet.text)}
    return "".join(block for block in _BLOCK.split(below) if block.split(":")[0] not in given)


@cache
def said(sheets: tuple[Example, ...]) -> list[Diagnostic]:
    """Return lint's findings for an example; with a state `before`, including those of `--against` that state."""
    if any(sheet.note == PHYSICS for sheet in sheets):
        return _played(sheets)
    if modules := {sheet.file: sheet.text for sheet in sheets if sheet.note == INSTALLED}:
        return _installed(modules, sheets)
    if any(sheet.language == "python" for sheet in sheets):
        return _with_code(sheets)
    before = [sheet._replace(note="") for sheet in sheets if sheet.note == "before"]
    now, found = check_files(BASE, laid(read_files(BASE), [sheet for sheet in sheets if sheet.note != "before"]))
    if before and now and (old := check_files(BASE, laid(read_files(BASE), before))[0]):
        return [*found, *against(old, now)]
    return list(found)


def _with_code(sheets: tuple[Example, ...]) -> list[Diagnostic]:
    """Return the findings of a project with Python files, which lint reads from the disk."""
    with TemporaryDirectory() as folder:
        for sheet in sheets:
            if sheet.language == "python":
                (Path(folder) / sheet.file).parent.mkdir(exist_ok=True)
                (Path(folder) / sheet.file).write_text(sheet.text, encoding="utf-8")
        return list(check_files(Path(folder), laid(read_files(BASE), sheets))[1])


def _installed(modules: Mapping[str, str], sheets: tuple[Example, ...]) -> list[Diagnostic]:
    """Return the findings with a distribution of these modules installed, the first of which has its manifest."""
    module = next(iter(modules)).removesuffix(".py")
    with TemporaryDirectory() as folder:
        write_distribution(Path(folder), module.replace("_", "-"), f"{module}:FEATURE", modules)
        with on_path(Path(folder)):
            return list(check_files(BASE, laid(read_files(BASE), sheets))[1])


def _played(sheets: tuple[Example, ...]) -> list[Diagnostic]:
    """Return the findings of `--physics` for a motion in the shipped project, with the model's robot and others."""
    files = laid(read_files(ROOT), sheets)
    asked = [sheet.file for sheet in sheets if sheet.file.startswith("motions/")]
    found = played(Findings((), files, str(ROOT), asked), lambda d: d.code in families()["physics"], OTHERS, keep=False)
    return list(found[0].diagnostics)


def written() -> dict[str, str]:
    """Return the pages of the docs, by file name."""
    index = "".join(f"\n## [{_title(name)}]({name}.md)\n\n{_list(name)}\n" for name in families())
    pages = {"README.md": f"{_INTRODUCTION}{index}"}
    for name, members in families().items():
        pages[f"{name}.md"] = f"# {_title(name)}\n" + "".join(f"\n{_section(page(code))}" for code in members)
    return pages


_INTRODUCTION = """# What lint finds

Written by `scripts/rule_pages.py` from the text that `lumen explain CODE` prints. [lint.md](../lint.md) explains how to
read a finding.
"""


def _title(family: str) -> str:
    return f"Rules: {family}"


def _list(family: str) -> str:
    return "\n".join(f"- [`{code}`]({family}.md#{code}): {codes()[code].summary}" for code in families()[family])


def _section(found: Page) -> str:
    wrong = "\n".join(_sheet(sheet) for sheet in found.wrong)
    right = "\n".join(_sheet(sheet) for sheet in found.right)
    output = "\n".join(str(d) for d in said(found.wrong))
    return (
        f"## {found.code}\n\n*{codes()[found.code].severity}.* {found.what}\n\n{found.why}\n\n"
        f"Wrong:\n\n{wrong}\nLint prints:\n\n```text\n{output}\n```\n\nRight:\n\n{right}"
    )


def _sheet(sheet: Example) -> str:
    before = " as it runs" if sheet.note == "before" else ""
    return f"`{sheet.file}`{before}\n\n```{sheet.language}\n{sheet.text}```\n"


def main() -> None:
    DOCS.mkdir(exist_ok=True)
    for name, text in written().items():
        (DOCS / name).write_text(text, encoding="utf-8")
    for stale in {file.name for file in DOCS.glob("*.md")} - written().keys():
        (DOCS / stale).unlink()
    print(f"wrote {len(written())} pages to {DOCS.relative_to(ROOT)}", file=sys.stderr)


if __name__ == "__main__":
    main()

"""Find small changes to files of other tools that change neither the result nor the findings of `lumen import`.

A change may be silent if its format's table (`format_tables` of `lumen.project.formats.importers`) lists the touched
name as without meaning, or if the import had already listed that part of the file before the change.
"""

import io
import json
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import redirect_stderr, redirect_stdout
from difflib import unified_diff
from functools import cache
from pathlib import Path
from random import Random
from typing import NamedTuple

from lumen.cli.main import main
from lumen.project.formats.conversion_findings import LOST
from lumen.project.formats.importers import format_tables
from tests import ROOT
from tests.attack.changes import CHANGERS, Change, changed, normal
from tests.attack.files import FOREIGN
from tests.guarded import temporary_folder

_DAMAGED = ("hostile", "what_is_written_loads")
"""Names of recorded imports of randomly damaged files, most of whose content is already lost."""


class Sample(NamedTuple):
    name: str
    ending: str
    text: str


class Finding(NamedTuple):
    code: str
    message: str
    line: int


class Outcome(NamedTuple):
    """The outcome of an import: the written files by name, the findings, and a fault that no file may cause."""

    code: int
    result: Mapping[str, bytes]
    findings: tuple[Finding, ...]
    fault: str = ""

    @property
    def told(self) -> Counter[tuple[str, str]]:
        return Counter((finding.code, finding.message) for finding in self.findings)


def samples(folders: Iterable[Path] = ()) -> list[Sample]:
    """Return every file of another tool in the tests, and those in the given folders."""
    found = [Sample(f"the smallest .{ending}", ending, text) for ending, text in FOREIGN.items()]
    for path in sorted((ROOT / "tests/golden/imports").glob("*.json")):
        for name, row in json.loads(path.read_text("utf-8")).items():
            if not name.startswith(_DAMAGED):
                found.append(Sample(f"{path.stem}: {name}", row["file"].rpartition(".")[2], row["text"]))
    for folder in (ROOT / "tests/reports/inputs", *folders):
        for path in sorted(folder.rglob("*")):
            ending = path.name.removesuffix(".txt").rpartition(".")[2]
            if ending in CHANGERS and path.is_file():
                found.append(Sample(path.name, ending, _text(path)))
    return [sample._replace(text=normal(*sample[1:])) for sample in found if sample.ending in CHANGERS]


def _text(path: Path) -> str:
    data = path.read_bytes()
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


class Importer:
    """Run `lumen import` in this process, in a folder of its own."""

    def __init__(self) -> None:
        self.folder = Path(temporary_folder("lumen-attack-"))

    def outcome(self, ending: str, text: str) -> Outcome:
        for path in self.folder.rglob("*"):
            if path.is_file():
                path.unlink()
        source, target = self.folder / f"file.{ending}", self.folder / "out.yaml"
        source.write_text(text, "utf-8", newline="", errors="replace")
        told = io.StringIO()
        try:
            with redirect_stderr(told), redirect_stdout(io.StringIO()):
                code = main(["import", str(source), "-o", str(target), "--format", "json"])
        except BaseException as error:
            return Outcome(-1, {}, (), repr(error))
        if code == 2:
            fault = told.getvalue() if told.getvalue().count("\n") > 1 or "Traceback" in told.getvalue() else ""
            return Outcome(code, {}, (Finding("refused", _unplaced(told.getvalue(), source), 0),), fault)
        rows = json.loads(told.getvalue()) if told.getvalue().strip() else {}
        findings = [Finding(row["code"], row["message"], row["line"]) for row in _rows(rows)]
        result = {p.name: p.read_bytes() for p in self.folder.rglob("*") if p.is_file() and p != source}
        return Outcome(code, result, tuple(findings))


def _rows(told: object) -> Iterator[dict[str, object]]:
    if isinstance(told, dict):
        if "message" in told and "code" in told:
            yield told
        else:
            for value in told.values():
                yield from _rows(value)
    elif isinstance(told, list):
        for value in told:
            yield from _rows(value)


def _unplaced(line: str, source: Path) -> str:
    return line.replace(str(source), source.name)


ENDINGS: Mapping[str, tuple[str, ...]] = {
    "scxml": ("SCXML",), "json": ("XState",), "motion": ("Webots' .motion",), "xar": ("Choregraphe's .xar",),
    "py": ("NAOqi's Python",), "fll": ("FLL",), "fcl": ("FCL",), "fis": (".fis",), "urdf": ("URDF",),
    "xml": ("SCXML", "URDF", "MJCF"),
}  # fmt: skip
"""The possible formats of each file ending."""


def passes_silently(ending: str, change: Change, before: Outcome, after: Outcome) -> bool:
    """Return whether a change with a meaning changes neither the result nor the findings."""
    if (before.code, before.result, before.told) != (after.code, after.result, after.told):
        return False
    if ending == "xml" and "<mujoco" in change.text and not change.misspelt:
        return False  # the result contains the whole model, with the change
    if ending == "urdf" and "out.xml" not in before.result:
        return False  # MuJoCo refuses the whole file, and a finding reports that
    if any("what follows it" in found.message and found.line <= change.line for found in before.findings):
        return False
    listed = {finding.line for finding in before.findings}
    lost = {found.line for found in before.findings if found.code == LOST or "is left out" in found.message}
    reported = change.line in listed or lost.intersection(change.around)
    return not (reported or _means_nothing(ending, change, once=bool(listed)))


def _means_nothing(ending: str, change: Change, *, once: bool) -> bool:
    """Return whether the touched names have no meaning, or are lost and reported `once` for the whole file."""
    tables = [format_tables()[name] for name in ENDINGS[ending]]
    anywhere = {name for table in tables for known in table.values() for name in known.meaningless}
    for place, name in change.touched:
        for table in tables:
            known = [table[key] for key in (place, "any element") if key in table]
            if any(_named(name, one.meaningless) or (once and _named(name, one.lost)) for one in known):
                return True
        if ending == "json" and name in anywhere:
            return True
    return False


def _named(name: str, names: Iterable[str]) -> bool:
    """Return whether a name is among these; an entry such as `get…` matches every name with that beginning."""
    return any(one.lower() == name.lower() or (one.endswith("…") and name.startswith(one[:-1])) for one in names)


class Trouble(NamedTuple):
    number: int
    sample: str
    text: str


class Report(NamedTuple):
    """The number of changes by file ending and by outcome (refused, listed, in the result), and the troubles."""

    tried: Counter[str]
    outcomes: Counter[str]
    troubles: list[Trouble]


def attack_imports(
    numbers: Iterable[int],
    folders: Iterable[Path] = (),
    endings: Collection[str] = frozenset(CHANGERS),
    most: int | None = None,
) -> Report:
    """Import randomly changed files, at most `most`; the number of a change determines it.

    A number counts only if the change alters a file that can be imported.
    """
    found, importer = samples(folders), Importer()
    before = cache(lambda at: importer.outcome(found[at].ending, found[at].text))
    by_ending: dict[str, list[int]] = {}
    for at, sample in enumerate(found):
        if sample.ending in endings:
            by_ending.setdefault(sample.ending, []).append(at)
    report = Report(Counter(), Counter(), [])
    for number in numbers:
        if report.tried.total() == most:
            break
        random = Random(number)
        ending = random.choice(sorted(by_ending))
        at = random.choice(by_ending[ending])
        change = changed(random, ending, found[at].text)
        old = before(at)
        if change is None or change.text == found[at].text or (old.code == 2 and not old.fault):
            continue
        new = importer.outcome(ending, change.text)
        report.tried[ending] += 1
        report.outcomes["refused" if new.code == 2 else "in the result" if new.result != old.result else "listed"] += 1
        for fault in (old.fault, new.fault):
            if fault:
                report.troubles.append(Trouble(number, found[at].name, fault[:500]))
        if not new.fault and passes_silently(ending, change, old, new):
            report.troubles.append(Trouble(number, found[at].name, f"line {change.line}: {change.what}: silent"))
    return report


def show(number: int, folders: Iterable[Path] = ()) -> str:
    """Return a change as a unified diff."""
    found = samples(folders)
    random = Random(number)
    ending = random.choice(sorted({sample.ending for sample in found}))
    sample = random.choice([one for one in found if one.ending == ending])
    change = changed(random, ending, sample.text)
    after = change.text.splitlines() if change else []
    return "\n".join(unified_diff(sample.text.splitlines(), after, sample.name, f"change {number}", lineterm=""))

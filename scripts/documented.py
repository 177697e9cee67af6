"""Runs the commands that the documentation shows, and compares their output: `python scripts/documented.py [PAGE ...]`.

A block of ```console has a `$` before each command and the output below it. The blocks of a page are run one after
another, in a copy of the shipped project. A comment above a block has more, `<!-- run: WORDS -->`, and `<!-- $ COMMAND
-->` is a step that the reader does by hand before it:

    in=empty          from here on in an empty folder
    file=PATH         the block below is this file, and is written (with `append=PATH`: added to it)
    ends=1            the last command ends with this code, not with 0
    physics, broker   only if the simulator, RabbitMQ, is installed
    robot, network    not run by this script: a person does it

A block of ```text needs one of these words:

    by=SCRIPT         printed by this script, which runs in real time: times and the order of lines are not compared
    not=drawing       a picture or a pattern made of characters
    not=measured      the figures of a benchmark that the page names; they differ from machine to machine
    not=recorded      printed once in a setting that this script can't make; the page describes it

In an output `…` is any text, and on a line of its own any lines. Numbers may differ by a fifth, or by 1; the line and
column of a file may not differ.
"""

import argparse
import contextlib
import importlib.util
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))  # for tests/rabbitmq.py
NOT_RUN = ("drawing", "measured", "recorded")
"""Reasons why a block of text is not compared."""
PROJECT = ("lumen.yaml", "behaviors", "functions", "knowledge", "fuzzy", "motions", "models", "schemas", "examples")
BEFORE = r"(?:^<!-- \$ (?P<before>.+?) -->\n+)?(?:^<!-- run: (?P<words>.+?) -->\n+)?"
BLOCK = re.compile(rf"(?m){BEFORE}^```(?P<language>\w+)[^\n]*\n(?P<text>[\s\S]*?)^```$")
NUMBER = re.compile(r"\d+(?:,\d{3})*(?:\.\d+)?")
PLACE = re.compile(r"(?<=\.)(yaml|md|xml|py|json)((?::\d+)+)")
"""The line, and optionally the column, after the name of a file."""
CLOCK = re.compile(r"^ *\d+:\d\d\.\d  ")
"""The time before a line of a transcript."""
END = "--- the end of a command:"
LONGEST = 400.0
"""The timeout of one block [s]."""


@dataclass(frozen=True)
class Shown:
    """A block of a page: commands with their outputs, or a file.

    `place` is its page and line; `words` are those of its `run:` comment; `before` is the command that the reader runs
    before it.
    """

    place: str
    language: str
    text: str
    words: tuple[str, ...]
    before: str = ""

    def word(self, key: str) -> str:
        """Return the value of a word `key=VALUE`; empty if there is no such word."""
        return next((word.partition("=")[2] for word in self.words if word.startswith(f"{key}=")), "")

    @property
    def needs(self) -> set[str]:
        """Return the facilities that the block needs."""
        return {"physics", "broker", "robot", "network"} & set(self.words)

    @property
    def runs(self) -> bool:
        """Return True if the runner has something to do with the block."""
        return self.language == "console" or any((self.before, *map(self.word, ("file", "append", "by"))))

    def commands(self) -> list[tuple[str, list[str]]]:
        """Return each command with the lines of its output."""
        parts = re.split(r"(?m)^\$ ", self.text)[1:]
        return [(command, output.splitlines()) for command, _, output in (part.partition("\n") for part in parts)]


def blocks(page: Path) -> Iterator[Shown]:
    """Yield the blocks of a page."""
    text = page.read_text(encoding="utf-8")
    for found in BLOCK.finditer(text):
        line = text.count("\n", 0, found.start("language")) + 1
        words = tuple((found["words"] or "").split())
        yield Shown(f"{page.relative_to(ROOT)}:{line}", found["language"], found["text"], words, found["before"] or "")


def available() -> set[str]:
    """Return the facilities of this machine that blocks may need."""
    there = {"physics"} if importlib.util.find_spec("mujoco") else set()
    return there | ({"broker"} if shutil.which("rabbitmq-server") else set())


def differing(expected: list[str], printed: list[str]) -> str | None:
    """Return the first expected line that is not printed at its place; None if the output is as expected."""
    at, free = 0, False
    for line in expected:
        if line.strip() == "…":
            free = True
            continue
        places = range(at, len(printed) if free else min(at + 1, len(printed)))
        place = next((n for n in places if same(line, printed[n])), None)
        if place is None:
            return line
        at, free = place + 1, False
    return None if free or at == len(printed) else f"only these lines, and not: {printed[at]}"


def missing(expected: list[str], printed: list[str]) -> str | None:
    """Return the first expected line that was printed nowhere; the times before the lines are not compared."""
    timeless = [CLOCK.sub("", line) for line in printed]
    return next((line for line in expected if not any(same(CLOCK.sub("", line), other) for other in timeless)), None)


def same(expected: str, printed: str) -> bool:
    """Return True if two lines differ only in spaces, in the text for `…` and a little in numbers."""
    wanted, line = (PLACE.sub(_spelled, " ".join(text.split())) for text in (expected, printed))
    parts = wanted.split("…")
    number = f"({NUMBER.pattern})"
    pattern = ".*".join(number.join(map(re.escape, NUMBER.split(part))) for part in parts)
    found = re.fullmatch(pattern, line)
    numbers = [number for part in parts for number in NUMBER.findall(part)]
    return bool(found) and all(map(_near, numbers, found.groups()))


def _spelled(place: re.Match[str]) -> str:
    """Return a line and a column in letters, so that they don't count as numbers, which may differ."""
    return place[1] + "".join(chr(ord("a") + int(sign)) if sign.isdigit() else sign for sign in place[2])


def _near(expected: str, printed: str) -> bool:
    a, b = (float(number.replace(",", "")) for number in (expected, printed))
    return abs(a - b) <= max(1.0, abs(a) / 5)


class Workplace:
    """A folder in which the blocks of one page are run, one after another."""

    def __init__(self, folder: Path, bus: str = "") -> None:
        self.bus = bus
        self.folder = folder / "lumen"
        self.empty = folder / "empty"
        self.empty.mkdir(parents=True)
        self.folder.mkdir()
        for source in (ROOT / name for name in PROJECT):
            if source.is_dir():
                shutil.copytree(source, self.folder / source.name, ignore=shutil.ignore_patterns(".lumen"))
            else:
                shutil.copy2(source, self.folder)
        self.here = self.folder

    def perform(self, block: Shown) -> Iterator[str]:
        """Run a block or write its file; yield a line for each difference from the page."""
        if block.word("in") == "empty":
            self.here = self.empty
        if block.before:
            self._run([block.before])
        if name := block.word("file") or block.word("append"):
            file = self.here / name
            file.parent.mkdir(parents=True, exist_ok=True)
            before = file.read_text(encoding="utf-8") if block.word("append") else ""
            file.write_text(before + block.text, encoding="utf-8")
            return
        if script := block.word("by"):
            (lines, _), *_ = self._run([f"python {ROOT / script}"]) or [([], -1)]
            if line := missing([line for line in block.text.splitlines() if line.strip()], lines):
                yield f"{block.place}: `python {script}` did not print\n    {line}\nbut\n" + "\n".join(lines)
            return
        if block.language != "console":
            return
        commands = block.commands()
        bus = {"LUMEN_BUS": self.bus} if "broker" in block.needs else {}
        printed = self._run([command for command, _ in commands], bus)
        for number, (command, expected) in enumerate(commands):
            lines, code = printed[number] if number < len(printed) else ([], -1)
            wanted = int(block.word("ends") or 0) if number == len(commands) - 1 else 0
            if code != wanted:
                yield f"{block.place}: `{command}` ended with {code}, not {wanted}:\n" + "\n".join(lines[-12:])
            elif (line := differing([line for line in expected if line], [line for line in lines if line])) is not None:
                yield f"{block.place}: `{command}` did not print\n    {line}\nbut\n" + "\n".join(lines[-30:])

    def _run(
        self, commands: list[str], variables: Mapping[str, str] = MappingProxyType({})
    ) -> list[tuple[list[str], int]]:
        """Return each command's output and exit code; background processes end with the block."""
        where = self.folder.parent / "where"
        script = "".join(f"{command}\nprintf '\\n%s %d\\n' '{END}' $?\n" for command in commands) + f"pwd >{where}\n"
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        environment = os.environ | variables | {"PATH": path, "COLUMNS": "120", "NO_COLOR": "1", "LC_ALL": "C.UTF-8"}
        with tempfile.TemporaryFile("w+", encoding="utf-8") as out:
            process = subprocess.Popen(
                ["bash", "-c", script], cwd=self.here, env=environment, stdin=subprocess.DEVNULL,
                stdout=out, stderr=subprocess.STDOUT, start_new_session=True,
            )  # fmt: skip
            try:
                process.wait(LONGEST)
            except subprocess.TimeoutExpired:
                print(f"{commands} took more than {LONGEST:.0f} s", file=sys.stderr)
            finally:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGTERM)
                process.wait(10)
            out.seek(0)
            text = out.read()
        if where.exists():
            self.here = Path(where.read_text(encoding="utf-8").strip())
        parts = re.split(rf"\n{re.escape(END)} (\d+)\n", text)
        return [(lines.splitlines(), int(code)) for lines, code in zip(parts[::2], parts[1::2], strict=False)]


@contextlib.contextmanager
def broker() -> Iterator[str]:
    """Yield the address of a private RabbitMQ on loopback."""
    from tests.rabbitmq import RabbitMQ

    rabbitmq = RabbitMQ()
    try:
        rabbitmq.start()
        yield rabbitmq.url
    finally:
        rabbitmq.stop()


def check(page: Path, there: set[str], bus: str = "") -> tuple[int, list[str], list[str]]:
    """Return the number of commands of a page that were run, the differences, and the blocks that were left out."""
    shown = [block for block in blocks(page) if block.runs]
    count, wrong, left = 0, [], []
    if not any((block.language == "console" or block.word("by")) and block.needs <= there for block in shown):
        return 0, [], [f"{block.place} ({', '.join(block.needs)})" for block in shown]
    with tempfile.TemporaryDirectory(prefix="lumen-documented-") as folder:
        place = Workplace(Path(folder), bus)
        for block in shown:
            if block.needs <= there:
                count += len(block.commands()) if block.language == "console" else bool(block.word("by"))
                wrong += place.perform(block)
            else:
                left.append(f"{block.place} ({', '.join(block.needs - there)})")
    return count, wrong, left


def all_pages() -> list[Path]:
    """Return README.md and the pages of docs/. Raises SystemExit if there are no pages."""
    if not (pages := sorted((ROOT / "docs").glob("*.md"))):
        raise SystemExit(f"no page is in {ROOT / 'docs'}: nothing is checked")
    return [ROOT / "README.md", *pages]


def main() -> int:
    parser = argparse.ArgumentParser(description="Run what the documentation shows, and compare what it prints.")
    parser.add_argument("pages", nargs="*", type=Path, metavar="PAGE", help="README.md and docs/*.md, if not said")
    began, there, count, bad = time.monotonic(), available(), 0, 0
    pages = [path.resolve() for path in parser.parse_args().pages] or all_pages()
    wanted = any("broker" in block.needs & there for page in pages for block in blocks(page))
    with broker() if wanted else contextlib.nullcontext("") as bus:
        for page in pages:
            ran, wrong, left = check(page, there, bus)
            count, bad = count + ran, bad + len(wrong)
            print("\n".join(wrong + [f"not run: {block}" for block in left]), end="\n" if wrong or left else "")
    print(f"{count} commands of the documentation, {bad} not as it says, {time.monotonic() - began:.0f} s")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())

"""Measure how long an editor waits for `lumen lsp`: from the last key to the findings, and from a key to completion.

The project is the shipped one, with a tour that was extended to 2,000 lines by repeated visits. A client types words
into it over standard input and output, one key every 60 ms, and then sends the requests of an editor (symbols, folds,
lenses, hints: everything that the server offers). Findings count once they are those of the whole word. Completion is
requested right after its key, while the project is being checked. The last key may also close a quote that hid the
rest of the file.

    python benchmarks/lsp.py
"""

import argparse
import os
import platform
import re
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.features.editor.client import Client

from lumen.project.files import read_files

ROOT = Path(__file__).parents[1]
TOUR = "behaviors/tour.yaml"
LINES, KEY_EVERY, TURNS = 2_000, 0.06, 20
AROUND = {
    "documentSymbolProvider": "documentSymbol",
    "foldingRangeProvider": "foldingRange",
    "codeLensProvider": "codeLens",
    "inlayHintProvider": "inlayHint",
    "documentLinkProvider": "documentLink",
}
"""The requests of an editor after every key, by capability."""


def main() -> int:
    print(f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}")
    with tempfile.TemporaryDirectory() as name:
        root = Path(name).resolve()
        for file, content in read_files(ROOT).items():
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_bytes(content)
        (root / TOUR).write_text(grown((ROOT / TOUR).read_text("utf-8"), LINES), "utf-8")
        with Client(root) as client:
            typist = Typist(client, TOUR)
            print(
                f"{TOUR}: {len(typist.lines):,} lines; {TURNS} times each: median and p95, and the server's CPU time\n"
            )
            asked = [name for capability, name in AROUND.items() if typist.can(capability)]
            print(f"beside each key: {', '.join(asked)}")
            for near, word, said in (
                ('onDone: "#offer_3"', 'onDone: "#ofer"', "`ofer`"),
                ("guard: context.name_tries < 2", "guard: context.nametries < 2", "`nametries`"),
            ):
                took = [typist.findings(near, word, said) for _ in range(TURNS)]
                print(f"{'findings, ' + word:42s} {shown(took)}")
            print(f"{'findings, a quote is closed':42s} {shown([typist.closed() for _ in range(TURNS)])}")
            for near, word in (('onDone: "#offer_3"', 'onDone: "#off'), ("{play: dance}", "{play: da")):
                took, counts = zip(*(typist.completion(near, word) for _ in range(TURNS)), strict=True)
                print(f"{'completion, ' + word:42s} {shown(list(took))}   {max(counts):,} proposals")
    return 0


def grown(text: str, lines: int) -> str:
    """Return the tour with copies of the guide's region, so that it has about that many lines."""
    guide = re.search(r"(?ms)^  guide:\n.*?(?=^  \w+:\n)", text)
    assert guide
    region = guide.group()
    copies = (lines - text.count("\n")) // region.count("\n")
    return text[: guide.end()] + "".join(_copied(region, n) for n in range(1, 1 + copies)) + text[guide.end() :]


def _copied(region: str, n: int) -> str:
    """Return a copy of a region with another name and unique state ids."""
    region = region.replace("  guide:", f"  guide_{n}:", 1).replace(", key: e}", "}")
    ids = "|".join(re.findall(r"(?m)(?:^ +|\{)id: (\w+)(?:$|, )", region))
    region = re.sub(rf"(?m)((?:^ +|\{{)id: )({ids})(?=$|, )", rf"\g<1>\g<2>_{n}", region)
    return re.sub(rf'"#({ids})"', rf'"#\g<1>_{n}"', region)


class Took(NamedTuple):
    """Wall time and CPU time of the server for an answer [s]."""

    wall: float
    cpu: float


class Typist:
    """Writes into one file as a person at a keyboard does, and measures the answers."""

    def __init__(self, client: Client, file: str) -> None:
        self.client, self.file, self.version = client, file, 1
        self.text = client.open(file)
        self.lines = self.text.split("\n")
        errors = [found for found in client.diagnostics(file) if found["severity"] == 1]
        assert errors == [], errors

    def can(self, capability: str) -> bool:
        """Return True if the server has the capability."""
        return bool(self.client.capabilities.get(capability))

    def findings(self, near: str, word: str, said: str) -> Took:
        """Return the time from the last key of a wrong word to a finding with the text `said`; then undo the edit."""
        line, start = self.spot(near)
        began = self.replace(line, start, len(near), word)
        self.around()
        self.until(lambda found: any(said in one["message"] for one in found))
        took = self.since(began)
        self.replace(line, start, len(word), near, at_once=True)
        self.until(lambda found: not found)
        return took

    def closed(self) -> Took:
        """Return the time from the key that closes a quote to the findings of a valid file."""
        line, start = self.spot("en: Never mind.")
        self.replace(line, start + 4, 0, '"', at_once=True)
        self.until(bool)
        began = self.replace(line, start + 16, 0, '"')
        self.around()
        self.until(lambda found: not found)
        took = self.since(began)
        self.replace(line, start + 4, 13, "Never mind.", at_once=True)
        return took

    def completion(self, near: str, word: str) -> tuple[Took, int]:
        """Return the time from the last key of an incomplete word to its proposals, and their number."""
        line, start = self.spot(near)
        self.replace(line, start, len(near), word[:-1])
        began = self.replace(line, start + len(word) - 1, 0, word[-1])
        answer = self.client.ask("completion", self.file, line, start + len(word))
        took = self.since(began)
        self.around()
        self.replace(line, start, len(word), near, at_once=True)
        self.until(lambda found: not found)
        return took, len(answer["items"] if isinstance(answer, dict) else answer)

    def spot(self, near: str) -> tuple[int, int]:
        """Return the line and column of the first occurrence of a text."""
        line = next(i for i, text in enumerate(self.lines) if near in text)
        return line, self.lines[line].index(near)

    def replace(self, line: int, start: int, wide: int, word: str, *, at_once: bool = False) -> Took:
        """Write a word in place of `wide` characters, key by key; return the clocks at the last key."""
        for i, key in enumerate([word] if at_once else word):
            if i:
                time.sleep(KEY_EVERY)
            pressed = self.clocks()
            self.key(line, start + (0 if at_once else i), 0 if i else wide, key)
        return pressed

    def clocks(self) -> Took:
        """Return the wall clock and the server's CPU time."""
        return Took(time.perf_counter(), cpu(self.client.process.pid))

    def since(self, began: Took) -> Took:
        """Return the times that have passed since other clocks."""
        now = self.clocks()
        return Took(now.wall - began.wall, now.cpu - began.cpu)

    def key(self, line: int, start: int, wide: int, key: str) -> None:
        """Send a change of the file: `key` in place of `wide` characters."""
        self.version += 1
        places = [{"line": line, "character": start + n} for n in (0, wide)]
        change = {"range": {"start": places[0], "end": places[1]}, "text": key}
        document = {"uri": self.client.uri(self.file), "version": self.version}
        self.client.notify("textDocument/didChange", textDocument=document, contentChanges=[change])

    def around(self) -> None:
        """Send the other requests of an editor."""
        document = {"uri": self.client.uri(self.file)}
        window = {"start": {"line": 0, "character": 0}, "end": {"line": 100, "character": 0}}
        for capability, method in AROUND.items():
            if self.can(capability):
                more = {"range": window} if method == "inlayHint" else {}
                self.client.ask_later(f"textDocument/{method}", textDocument=document, **more)

    def until(self, wanted: Callable[[list[dict[str, Any]]], bool]) -> None:
        """Wait until the findings satisfy a condition."""
        while not wanted(self.client.diagnostics(self.file)):
            pass


def cpu(pid: int) -> float:
    """Return the CPU time of all threads of a process and of its descendants [s]."""
    tasks = [*Path(f"/proc/{pid}/task").iterdir()]
    own = sum(int((task / "schedstat").read_text().split()[0]) for task in tasks) / 1e9
    return own + sum(cpu(int(child)) for task in tasks for child in (task / "children").read_text().split())


def shown(took: list[Took]) -> str:
    """Return median and 95th percentile of the wall time, and the median of the CPU time, as text."""
    wall = sorted(each.wall for each in took)
    p95, cpu = statistics.quantiles(wall, n=20)[-1], statistics.median(each.cpu for each in took)
    return f"{1e3 * statistics.median(wall):5.0f} ms {1e3 * p95:5.0f} ms   {1e3 * cpu:4.0f} ms"


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    sys.exit(main())

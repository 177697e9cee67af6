"""List prose that reads like a translation: in pages, in messages of the engine, in docstrings and in changed lines.

    python scripts/prose.py                      # hits per 1,000 words; exit code 1 if a limit is exceeded
    python scripts/prose.py --list               # and each hit of the groups that exceed their limit
    python scripts/prose.py docs/lint.md engine/lumen/lint      # each hit in these files
    python scripts/prose.py --draw 60 --seed 1   # 60 messages, docstrings and sentences, for a reader who wrote none
    python scripts/prose.py --draw 60 --among starlette pika --key KEY   # 60 functions: half are of these packages

Messages are the string literals of the engine that hold a sentence; the values in an f-string print as `…`. A hit is a
place to look at, not a verdict: a pattern can be right where it is found. `make check` runs this script.
"""

import argparse
import ast
import importlib.util
import re
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from itertools import chain
from pathlib import Path
from random import Random
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
MOST_LINES = 60
"""The longest function that a reader gets in a mixed draw [lines]."""
PATTERNS = {
    "headless what/who": r"^(What|Who|Whoever|Whatever)\b(?![^.]*\?)",
    "mid-sentence what/who": (
        r"\b(of|by|in|for|to|with|that) (what|who) "
        r"(is|are|was|were|has|have|can|may|it|they|he|she|one|nobody|somebody)\b"
    ),
    "somebody/nobody": r"\b[SsNn]o(me)?body\b",
    "where for if": (
        r"\b[Ww]here (it|they|that|there|this|one|nothing|none|no|nobody|somebody|anybody|not|an?|"
        r"the \w+ (is|are|has|have|was|were|can|may|does|do))\b"
    ),
    "stands for is": r"\b(stands?|stood) (in|at|on|there|beside|alone|under|above|below|before|after|for)\b",
    "say/tell of things": r"\b(says?|said|tells?|told) (what|that|so|it|of|how|which|whether|where|why|nothing)\b",
    "take for accept/use": (
        r"\b(takes?|taken|took) "
        r"(it|them|that|what|no|the (steps?|files?|events?|message|first|change)|a step|its|an?)\b"
    ),
    "goes by/let be": (
        r"\b(goes? by|go on|goes on|went on|(is|are) to be|has to|as good as|at the most|of its own accord|"
        r"none is|is none|is nobody|from then on|"
        r"let (it|them|its|their|the|an?) \w+ (be|go|rest|have|take|run|end|move|come))\b"
    ),
    "fragment": r"^(Whose|Than|As long as|So that|Nothing|None|How many|How much|How long|How far|How often)\b",
}
COMPILED = {kind: re.compile(pattern) for kind, pattern in PATTERNS.items()}
COMMENT = re.compile(r"(?:^|\s)# (.*)$")
SENTENCE = re.compile(r"[a-z]{2,} [a-z]{2,}")


FIRST_HOUR = "concepts installing change-the-tour own-exhibition museum lint stories troubleshooting glossary"
FRONT = ("README.md", "CHANGELOG.md", *(f"docs/{page}.md" for page in FIRST_HOUR.split()))
"""The files that a newcomer reads in the first hour."""
ENGINE = "engine/lumen"
TEXTS = "engine/lumen/features/console/pages/texts/en.js"
LIMIT = 1.0
"""Hits per 1,000 words in all that users read first."""
OTHER_PAGES, CODE, TOOLS = 2.5, 1.0, 3.0
"""The rates of the rest, which must not grow."""
CHANGED = 2.0
"""Hits per 1,000 words in changed lines; one is always allowed."""


class Prose(NamedTuple):
    """A line of a page, or a string of a module."""

    file: str
    line: int
    text: str

    @property
    def hits(self) -> Sequence[str]:
        """The kind of each pattern that the text matches."""
        return kinds(self.text)


@cache
def kinds(text: str) -> Sequence[str]:
    """Return the kind of each pattern that a text matches."""
    return tuple(kind for kind, pattern in COMPILED.items() if pattern.search(text))


class Counted(NamedTuple):
    """A group of prose with the limit of its hits per 1,000 words."""

    name: str
    limit: float
    prose: Sequence[Prose]
    spare: int = 0
    """Hits that are allowed in any case."""

    @property
    def words(self) -> int:
        return sum(len(prose.text.split()) for prose in self.prose)

    @property
    def found(self) -> list[tuple[Prose, str]]:
        return [(prose, kind) for prose in self.prose for kind in prose.hits]

    @property
    def exceeded(self) -> bool:
        return len(self.found) > max(self.spare, self.limit * self.words / 1000)

    def __str__(self) -> str:
        found, words = len(self.found), self.words
        return (
            f"{1000 * found / max(words, 1):5.1f}  {found:5} in {words:7,} words  {self.name} (at most {self.limit:g})"
        )


@cache
def messages(file: str) -> Sequence[Prose]:
    """Return each string of a Python module or of the console's texts that holds a sentence, without docstrings."""
    return tuple(_messages(file))


def _messages(file: str) -> Iterator[Prose]:
    if file.endswith(".js"):
        for number, row in enumerate((ROOT / file).read_text(encoding="utf-8").splitlines(), 1):
            yield from (Prose(file, number, told) for told in re.findall(r'": "((?:[^"\\\\]|\\\\.)+)"', row))
        return
    nodes = parsed(file)
    left_out = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    for node in nodes:
        if isinstance(node, ast.JoinedStr):
            left_out.update(id(part) for part in ast.walk(node) if part is not node)
    for node in nodes:
        if isinstance(node, ast.JoinedStr):
            told = "".join(str(part.value) if isinstance(part, ast.Constant) else "…" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            told = node.value
        else:
            continue
        if id(node) not in left_out and told.count(" ") >= 3 and SENTENCE.search(told):
            yield Prose(file, node.lineno, " ".join(told.split()))


def comments(file: str) -> Iterator[Prose]:
    """Yield the lines of a module's docstrings, and its comments of more than one word."""
    for node in parsed(file):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            for offset, row in enumerate(node.value.value.splitlines()):
                if row.strip():
                    yield Prose(file, node.lineno + offset, row.strip())
    for number, row in enumerate((ROOT / file).read_text(encoding="utf-8").splitlines(), 1):
        if (comment := COMMENT.search(row)) and " " in comment[1]:
            yield Prose(file, number, comment[1])


@cache
def parsed(file: str) -> list[ast.AST]:
    """Return the expression statements, constants and f-strings of a module."""
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    return [node for node in ast.walk(tree) if isinstance(node, (ast.Expr, ast.Constant, ast.JoinedStr))]


def paragraphs(file: str) -> Iterator[Prose]:
    """Yield the lines of a page that are neither blank nor code."""
    fenced = False
    for number, row in enumerate((ROOT / file).read_text(encoding="utf-8").splitlines(), 1):
        if row.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced and not row.startswith("    ") and row.strip():
            yield Prose(file, number, re.sub(r"`[^`]*`", "`…`", row.strip().lstrip("-*#| ")))


def sentences(file: str) -> Iterator[Prose]:
    """Yield the sentences of a page that have five words or more, with the code between backticks."""
    text, fenced, start = "", False, 1
    for number, row in enumerate([*(ROOT / file).read_text(encoding="utf-8").splitlines(), ""], 1):
        fenced ^= row.lstrip().startswith("```")
        ends = (
            fenced
            or not row.strip()
            or row.lstrip().startswith(("- ", "#", "|", "```", "<", "!"))
            or row.startswith("    ")
        )
        if ends:
            yield from (
                Prose(file, start, part) for part in re.split(r"(?<=[.?!]) +(?=[A-Z`])", text) if len(part.split()) >= 5
            )
            text, start = "", number
        code = fenced or row.startswith("    ") or row.lstrip().startswith("```")
        if row.strip() and not code and not row.startswith(("#", "<", "!")):
            text += (" " if text else "") + row.strip().removeprefix("- ").lstrip("| ")


def prose(file: str) -> Iterable[Prose]:
    """Return all text in a file that a person reads."""
    if file.endswith(".md"):
        return paragraphs(file)
    return chain(messages(file), comments(file)) if file.endswith(".py") else messages(file)


def files() -> list[str]:
    listed = subprocess.run(
        ["git", "ls-files", "*.py", "*.md", TEXTS], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    return [file for file in listed.splitlines() if (ROOT / file).exists()]


def of_engine(all_files: Iterable[str]) -> list[Prose]:
    return [
        told
        for file in all_files
        if file.startswith(ENGINE) and file.endswith((".py", ".js"))
        for told in messages(file)
    ]


def groups() -> Iterator[Counted]:
    every = files()
    pages = [file for file in every if file.endswith(".md")]
    shipped = [page for page in pages if page.startswith(ENGINE)]
    generated = ("docs/rules/", "docs/commands/")
    for page in FRONT:
        yield Counted(page, LIMIT, list(paragraphs(page)))
    yield Counted("messages of the engine", LIMIT, of_engine(every))
    yield Counted("pages of `lumen explain` and `--help`", LIMIT, _all(paragraphs, shipped))
    others = [page for page in pages if page not in FRONT and page not in shipped and not page.startswith(generated)]
    yield Counted("other pages", OTHER_PAGES, _all(paragraphs, others))
    yield Counted(
        "docstrings and comments of the engine",
        CODE,
        _all(comments, [file for file in every if file.startswith(ENGINE) and file.endswith(".py")]),
    )
    python = [file for file in every if file.endswith(".py")]
    beside = [file for file in python if file.startswith(("scripts/", "benchmarks/"))]
    tests = [file for file in python if file.startswith("tests/")]
    yield Counted("docstrings and comments of the tests", TOOLS, _all(comments, tests))
    yield Counted("docstrings and comments of scripts and benchmarks", TOOLS, _all(comments, beside))
    added = changed_lines()
    yield Counted(
        "changed lines", CHANGED, [told for file in added for told in prose(file) if told.line in added[file]], spare=1
    )


def changed_lines() -> dict[str, set[int]]:
    """Return the numbers of the lines, by file, that a branch adds to main, or else the last commit to its parent.

    Moved lines are left out.
    """
    for base in (["merge-base", "HEAD", "origin/main"], ["rev-parse", "HEAD~1"]):
        known = subprocess.run(["git", *base], cwd=ROOT, capture_output=True, text=True).stdout.strip()
        head = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
        if known and known != head:
            break
    else:
        return {}
    command = ["git", "diff", "-U0", "-M", "-l0", known]  # all files, without a limit: else a moved file is a new one
    diff = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, errors="replace").stdout
    before = {row[1:].strip() for row in diff.splitlines() if row.startswith("-")}
    added: dict[str, set[int]] = {}
    file, line = "", 0
    for row in diff.splitlines():
        if row.startswith("+++ "):
            file = row.removeprefix("+++ b/")
        elif place := re.match(r"@@ -\S+ \+(\d+)", row):
            line = int(place[1])
        elif row.startswith("+"):
            if row[1:].strip() not in before:  # else it was moved
                added.setdefault(file, set()).add(line)
            line += 1
    return {file: lines for file, lines in added.items() if (ROOT / file).exists() and _is_read(file)}


def _is_read(file: str) -> bool:
    """Return whether a file is Python, a page that people write, or the texts of the console."""
    return file == TEXTS or (file.endswith((".py", ".md")) and not file.startswith(("docs/rules/", "docs/commands/")))


def docstrings(file: str) -> Iterator[Prose]:
    """Yield the docstring of each class and function of a module, after its signature."""
    for node in ast.walk(ast.parse((ROOT / file).read_text(encoding="utf-8"))):
        if isinstance(node, (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)) and (
            told := ast.get_docstring(node)
        ):
            if isinstance(node, ast.ClassDef):
                signature = f"class {node.name}({', '.join(map(ast.unparse, node.bases))})"
            else:
                returned = f" -> {ast.unparse(node.returns)}" if node.returns else ""
                signature = f"{node.name}({ast.unparse(node.args)}){returned}"
            yield Prose(file, node.lineno, f"{signature}: {' '.join(told.split())}")


def draw(count: int, seed: int) -> None:
    """Print messages and docstrings of the engine and sentences of the pages, numbered, drawn with a seed."""
    every, random = files(), Random(seed)
    engine = [file for file in every if file.startswith(ENGINE) and file.endswith(".py")]
    written = [file for file in every if file.startswith("docs/") and _is_read(file) and "/decisions/" not in file]
    for name, drawn in (
        ("Messages", of_engine(every)),
        ("Sentences of the first hour", _all(sentences, FRONT)),
        ("Docstrings", _all(docstrings, engine)),
        ("Sentences of docs/", _all(sentences, [file for file in written if file.endswith(".md")])),
    ):
        print(f"{name}, {count} of {len(drawn):,}, seed {seed}:")
        for number, told in enumerate(random.sample(drawn, min(count, len(drawn))), 1):
            print(f"{number:3}. {told.text}   [{told.file}:{told.line}]")


def draw_among(count: int, seed: int, packages: Sequence[str], key: Path) -> None:
    """Print functions with docstrings, half from the engine and half from installed packages, in random order.

    The reader does not see which are whose; the file `key` gets their places. Functions longer than MOST_LINES are left
    out.
    """
    random = Random(seed)
    engine = [ROOT / file for file in files() if file.startswith(ENGINE) and file.endswith(".py")]
    groups = [_functions(engine), *(_functions(_modules_of(package)) for package in packages)]
    shares = [count // 2, *(count // 2 // len(packages) for _ in packages)]
    drawn = [
        each
        for group, share in zip(groups, shares, strict=True)
        for each in random.sample(group, min(share, len(group)))
    ]
    random.shuffle(drawn)
    for number, (_, source) in enumerate(drawn, 1):
        print(f"{number}.\n{source}\n")
    key.write_text("".join(f"{number} {place}\n" for number, (place, _) in enumerate(drawn, 1)), encoding="utf-8")


def _modules_of(package: str) -> list[Path]:
    spec = importlib.util.find_spec(package)
    if spec is None or not spec.submodule_search_locations:
        raise SystemExit(f"there is no package {package} here: install it, or name another")
    return sorted(Path(spec.submodule_search_locations[0]).rglob("*.py"))


def _functions(modules: Iterable[Path]) -> list[tuple[str, str]]:
    """Return the place and the source of each function that has a docstring of three words or more."""
    found = []
    for module in modules:
        text = module.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text)):
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                continue
            lines = (node.end_lineno or node.lineno) - node.lineno + 1
            if len((ast.get_docstring(node) or "").split()) >= 3 and lines <= MOST_LINES:
                source = "\n".join(text.splitlines()[node.lineno - 1 : node.end_lineno])
                found.append((f"{module}:{node.lineno}", textwrap.dedent(source)))
    return found


def _all(read: Callable[[str], Iterable[Prose]], listed: Iterable[str]) -> list[Prose]:
    return [told for file in listed for told in read(file)]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="*", metavar="PATH", help="list each hit in these files and folders")
    parser.add_argument("--list", action="store_true", help="list each hit of the groups that exceed their limit")
    parser.add_argument("--draw", type=int, metavar="N", help="print N drawn messages, docstrings and sentences")
    parser.add_argument("--among", nargs="+", metavar="PACKAGE", help="with --draw: functions, half of these packages")
    parser.add_argument("--key", type=Path, help="with --among: the file for the places of the functions")
    parser.add_argument("--seed", type=int, default=1, help="of --draw (default: 1)")
    options = parser.parse_args()
    if options.among:
        if not options.draw or options.key is None:
            parser.error("--among needs --draw and --key")
        draw_among(options.draw, options.seed, options.among, options.key)
        return 0
    if options.draw:
        draw(options.draw, options.seed)
        return 0
    if options.paths:
        chosen = [file for file in files() if any(Path(file).is_relative_to(path) for path in options.paths)]
        counted = [Counted("these files", LIMIT, _all(prose, chosen))]
    else:
        counted = list(groups())
    for group in counted:
        if options.paths or (options.list and group.exceeded):
            for told, kind in group.found:
                print(f"{told.file}:{told.line} [{kind}] {told.text[:150]}")
    print("hits per 1,000 words:")
    for group in counted:
        print(f"{group}{'  TOO MANY' if group.exceeded else ''}")
    return int(not options.paths and any(group.exceeded for group in counted))


if __name__ == "__main__":
    sys.exit(main())

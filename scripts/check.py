"""Checks the repository's own order: `python scripts/check.py` lists whatever is out of order; `make check` runs it.

Each check is a loop over files or rows. It yields the name of each item and its problem, which is empty if there is no
problem. A loop with too few items has failed: its pattern no longer matches.
"""

import ast
import json
import re
import sys
import tomllib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import locks
import schemas
import yaml
from documented import NOT_RUN, all_pages, blocks
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from lumen.expressions.function_table import functions
from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.rglob("*.md"))]
WORKFLOWS = ["action.yml", ".github/workflows/tests.yml", ".pre-commit-config.yaml", ".pre-commit-hooks.yaml"]
REQUIREMENTS = [f"locks/{group}.txt" for group in locks.GROUPS]
SIMULATION = {"mujoco", "dm-control", "scipy", "pillow", "imageio-ffmpeg", "matplotlib", "labmaze"}
"""Packages that the core must not require."""
PACKAGE_FILES = "https://files.pythonhosted.org/packages/"
BLOCK_WORDS = {"in", "file", "append", "ends", "physics", "broker", "robot", "network", "by", "not"}
"""The words for the runner that are allowed at the fence of a block."""

BLOCK = re.compile(r"(?m)^(?:```|````)[\s\S]*?^(?:```|````)$")
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"(?m)^#+ (.+)$")
RECORD = r"\[\d+\]\([^)]+\)"
STATUS = re.compile(rf"accepted|(?:accepted, changed by|superseded by) {RECORD}(?: and {RECORD})*")

Looked = tuple[str, str]
"""The name of an item and its problem, empty if there is no problem."""
Check = Callable[[], Iterable[Looked]]


def actions_are_named_by_their_commits() -> Iterator[Looked]:
    for path in [*(ROOT / name for name in WORKFLOWS), ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]:
        named = re.findall(r"uses: *\S+@(\S+)", path.read_text(encoding="utf-8"))
        loose = [ref for ref in named if not re.fullmatch(r"[0-9a-f]{40}|COMMIT", ref)]
        yield _name(path), _listed("pin by the 40 digits of a commit", loose)


def packages_are_pinned_by_the_hashes_of_their_files() -> Iterator[Looked]:
    for file in REQUIREMENTS:
        yield file, "names an index" if "//" in (ROOT / file).read_text(encoding="utf-8") else ""
        for package, version, hashes in requirements(file):
            yield f"{file}: {package}", "" if version and hashes else "pin by a version and the hashes of its files"


def packages_are_pinned_to_one_version() -> Iterator[Looked]:
    versions: dict[str, set[str]] = {}
    for file in REQUIREMENTS:
        for package, version, _ in requirements(file):
            versions.setdefault(package, set()).add(version)
    for package, found in versions.items():
        yield package, _listed("pin to one version", sorted(found)) if len(found) > 1 else ""


def the_core_needs_no_simulation() -> Iterator[Looked]:
    core, whole = ({package for package, _, _ in requirements(file)} for file in REQUIREMENTS[:2])
    for package in sorted(core):
        yield f"locks/core.txt: {package}", "belongs to locks/run.txt only" if package in SIMULATION else ""
    for package in sorted(SIMULATION - {"scipy", "labmaze"}):
        yield f"locks/run.txt: {package}", "" if package in whole else "is missing"


def schemas_are_written_from_their_sources() -> Iterator[Looked]:
    for path, text in schemas.composed():
        there = path.exists() and path.read_text(encoding="utf-8") == text
        yield _name(path), "" if there else "write it again: scripts/schemas.py"


def requirements_for_pip_are_written_from_the_lock() -> Iterator[Looked]:
    for path, text in locks.exports(locks.read()).items():
        yield _name(path), "" if path.read_text(encoding="utf-8") == text else "write it again: scripts/locks.py"


def the_lock_names_files_of_the_package_index_only() -> Iterator[Looked]:
    for package in locks.read()["packages"]:
        urls = [file["url"] for file in [package.get("sdist", {"url": PACKAGE_FILES}), *package.get("wheels", ())]]
        yield package["name"], _listed("is elsewhere", [url for url in urls if not url.startswith(PACKAGE_FILES)])


def the_lock_meets_what_pyproject_requires() -> Iterator[Looked]:
    pinned, known = locks.pins(locks.read()), set[str]()
    for group, lines in locks.required().items():
        known |= {package for package, _, _ in requirements(f"locks/{group}.txt")}
        for requirement in map(Requirement, lines):
            name = canonicalize_name(requirement.name)
            fits = name in known and requirement.specifier.contains(pinned[name])
            yield f"{group}: {requirement}", "" if fits else "lock it: scripts/locks.py"


def set_up_checks_the_hashes() -> Iterator[Looked]:
    for row in (ROOT / "scripts/set_up.sh").read_text(encoding="utf-8").splitlines():
        if row.strip().startswith("install -"):
            checked = "--require-hashes" in row or "--no-deps --no-build-isolation" in row
            yield row.strip(), "" if checked else "install with --require-hashes"


def links_lead_to_files_and_headings() -> Iterator[Looked]:
    for page in PAGES:
        lost = []
        for link in LINK.findall(BLOCK.sub("", page.read_text(encoding="utf-8"))):
            if re.match(r"[a-z]+:", link):
                continue
            file, _, anchor = link.partition("#")
            target = page.parent / file if file else page
            if not target.exists() or (anchor and target.suffix == ".md" and anchor not in anchors(target)):
                lost.append(link)
        yield _name(page), _listed("lead nowhere", lost)


def the_index_lists_every_page() -> Iterator[Looked]:
    listed = set(re.findall(r"(?m)^- \[[^\]]+\]\(([\w./-]+)\)", (DOCS / "README.md").read_text(encoding="utf-8")))
    there = {file.relative_to(DOCS).as_posix() for file in [*DOCS.glob("*.md"), *DOCS.glob("*/README.md")]}
    for page in sorted(there - {"README.md"}):
        yield f"docs/{page}", "" if page in listed else "add it to docs/README.md"


def each_decision_has_a_title_and_a_status() -> Iterator[Looked]:
    records = {file.name for file in decisions()}
    for file in decisions():
        number, title, status = title_and_status(file)
        later = re.findall(r"\[(\d+)\]\(([^)]+)\)", status)
        lost = [name for no, name in later if name not in records - {file.name} or not name.startswith(f"{no}-")]
        problems = [
            *["begin with `# NUMBER TITLE`, with the number of the file"] * (not title or number != file.name[:3]),
            *["write `Status: accepted` or `Status: superseded by [NUMBER](FILE)` below the title"]
            * (not STATUS.fullmatch(status)),
            *[_listed("the status names no other record", lost)] * bool(lost),
        ]
        yield _name(file), "; ".join(problems)


def the_index_of_decisions_has_each_title_and_status() -> Iterator[Looked]:
    text = (DOCS / "decisions/README.md").read_text(encoding="utf-8")
    rows = re.findall(r"(?m)^- \[(\d+)\]\(([^)]+)\) (.+)$", text)
    for file in decisions():
        number, title, status = title_and_status(file)
        shown = [(no, row) for no, name, row in rows if name == file.name]
        expected = [(number, f"{title}: {status}")]
        wanted = f"the index needs one row: - [{number}]({file.name}) {title}: {status}"
        yield _name(file), "" if shown == expected else wanted
    for _, name, _ in rows:
        yield f"docs/decisions/{name}", "" if (DOCS / "decisions" / name).exists() else "is in the index, but not there"


def the_version_is_the_same_everywhere() -> Iterator[Looked]:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    places = {
        "engine/lumen/__init__.py": r'^__version__ = "([^"]+)"',
        "editors/vscode/package.json": r'^  "version": "([^"]+)"',
        "CHANGELOG.md": r"\A[\s\S]*?^## \[(\d[^\]]*)\]",
        **{_name(page): r"lumen_robot-([\d.]+)-py3" for page in PAGES if "lumen_robot-" in page.read_text("utf-8")},
    }
    for place, pattern in places.items():
        found = set(re.findall(pattern, (ROOT / place).read_text(encoding="utf-8"), re.MULTILINE))
        yield place, "" if found == {version} else f"has version {', '.join(sorted(found))}, pyproject.toml {version}"


def the_page_about_the_environment_names_every_variable() -> Iterator[Looked]:
    page = (DOCS / "environment.md").read_text(encoding="utf-8")
    code = "".join(file.read_text(encoding="utf-8") for file in (ROOT / "engine/lumen").rglob("*.py"))
    read = set(re.findall(r'"(LUMEN_[A-Z_]+)"', code)) | set(re.findall(r'environ(?:\.get\(|\[)"(\w+)"(?!\] =)', code))
    for name in sorted(read - {"GITHUB_WORKSPACE", "LOCALAPPDATA", "TERM"}):
        yield name, "" if f"`{name}`" in page else "is read by the engine: add it to docs/environment.md"


def blocks_of_pages_say_what_the_runner_knows() -> Iterator[Looked]:
    for page in all_pages():
        for block in blocks(page):
            unknown = sorted({word.partition("=")[0] for word in block.words} - BLOCK_WORDS)
            bare = block.language == "console" and not block.text.startswith("$ ")
            wrong = [*unknown, *["a console block begins with `$ `"] * bare]
            yield str(block.place), _listed("the runner does not know", wrong)


def blocks_of_text_are_compared_or_say_why_not() -> Iterator[Looked]:
    """Check blocks of text: output of a command belongs in a console block, which scripts/documented.py runs."""
    for page in all_pages():
        for block in blocks(page):
            if block.language == "text":
                script = block.word("by")
                fine = (ROOT / script).is_file() if script else block.word("not") in NOT_RUN
                yield block.place, "" if fine else f"make it a console block, or add by= or not={'|'.join(NOT_RUN)}"
        bare = any(not language or (language == "text" and indent) for indent, language in _fences(page))
        yield (
            _name(page),
            "the runner can't see a block without a language, or an indented one" if bare else "",
        )


def places_in_files_are_compared() -> Iterator[Looked]:
    """Check that no page names a line of a file outside of the blocks that are run, because lines move."""
    for page in all_pages():
        prose = BLOCK.sub("", page.read_text(encoding="utf-8"))
        yield _name(page), _listed("remove the line number", re.findall(r"[\w*-]+\.(?:yaml|py|md|xml):\d+", prose))


def every_key_of_the_files_is_on_a_page() -> Iterator[Looked]:
    """Check that yaml.md, with the pages that it links to, lists all keys of the YAML files."""
    pages = "\n".join(page.read_text(encoding="utf-8") for page in sorted(DOCS.glob("*.md")))
    shown = set(re.findall(r"[\w-]+", "\n".join(re.findall(r"`[^`\n]+`|^```[\s\S]*?^```", pages, re.MULTILINE))))
    for file in sorted((ROOT / "schemas").glob("*.schema.json")):
        if file.name != "message.schema.json":  # its keys are those of JSON Schema itself
            for key in sorted(_keys(json.loads(file.read_text(encoding="utf-8"))) - {"propertyNames"}):
                yield f"{file.name}: {key}", "" if key in shown else "is on no page of docs/"


def the_page_about_expressions_lists_every_function() -> Iterator[Looked]:
    page = (DOCS / "expressions.md").read_text(encoding="utf-8")
    table = page.partition("\n## Functions\n")[2].partition("\n\n**")[0]
    listed = set(re.findall(r"`(\w+)\(", table))
    for name in sorted(listed | functions().keys()):
        yield name, "" if name in listed & functions().keys() else "is a function, or a row of the table, only"


def quoted_messages_are_printed() -> Iterator[Looked]:
    """Check that messages in the first column of docs/troubleshooting.md are texts of the engine; `…` is a value."""
    sources = (ast.parse(file.read_text(encoding="utf-8")) for file in sorted((ROOT / "engine/lumen").rglob("*.py")))
    texts = "\n".join(_message(node) for tree in sources for node in _literals(tree))
    for table in re.findall(
        r"(?m)^\| the terminal prints .*\n((?:\|.*\n)+)", (DOCS / "troubleshooting.md").read_text()
    ):
        for row in table.splitlines()[1:]:
            for quoted in re.findall(r"`([^`]{8,})`", row.split(" | ")[0]):
                yield quoted, "" if quoted in texts else "is printed by no source of the engine"


def pyyaml_reads_the_shipped_files() -> Iterator[Looked]:
    """Check that PyYAML, which implements YAML 1.1, reads the files; tests/house/test_other_readers.py has YAML 1.2."""
    for path in [ROOT / "lumen.yaml", *(f for name in PROJECT_FOLDERS for f in sorted((ROOT / name).rglob("*.yaml")))]:
        try:
            wrong = "" if yaml.safe_load(path.read_text("utf-8")) else "is empty to PyYAML"
        except yaml.YAMLError as error:
            wrong = str(error)
        yield _name(path), wrong


CHECKS: dict[Check, int] = {
    actions_are_named_by_their_commits: 150,
    packages_are_pinned_by_the_hashes_of_their_files: 100,
    packages_are_pinned_to_one_version: 100,
    the_core_needs_no_simulation: 10,
    schemas_are_written_from_their_sources: 3,
    requirements_for_pip_are_written_from_the_lock: 4,
    the_lock_names_files_of_the_package_index_only: 150,
    the_lock_meets_what_pyproject_requires: 50,
    set_up_checks_the_hashes: 4,
    links_lead_to_files_and_headings: 150,
    the_index_lists_every_page: 40,
    each_decision_has_a_title_and_a_status: 80,
    the_index_of_decisions_has_each_title_and_status: 160,
    the_version_is_the_same_everywhere: 5,
    the_page_about_the_environment_names_every_variable: 8,
    blocks_of_pages_say_what_the_runner_knows: 120,
    blocks_of_text_are_compared_or_say_why_not: 45,
    places_in_files_are_compared: 45,
    quoted_messages_are_printed: 10,
    every_key_of_the_files_is_on_a_page: 500,
    the_page_about_expressions_lists_every_function: 20,
    pyyaml_reads_the_shipped_files: 120,
}
"""Each check, and the least number of its items."""


def wrong(check: Check, at_least: int) -> list[str]:
    """Return a line for each problem that a check found, and one if it looked at fewer than `at_least` things."""
    looked = list(check())
    said = [f"{name}: {problem}" for name, problem in looked if problem]
    few = f"looked at {len(looked)} things, not at least {at_least}: its pattern no longer matches"
    return [*said, *[few] * (len(looked) < at_least)]


def requirements(file: str) -> Iterator[tuple[str, str, int]]:
    """Yield name, version and number of hashes of each requirement in a file; an unpinned row has an empty version."""
    text = re.sub(r"(?m)^(#|-r ).*\n", "", (ROOT / file).read_text(encoding="utf-8"))
    for row in text.replace("\\\n", " ").splitlines():
        found = re.match(r"([A-Za-z0-9._-]+)==([^ ;]+)", row)
        name, version = found.groups() if found else (row[:60], "")
        yield name, version, len(re.findall(r"--hash=sha256:[0-9a-f]{64}\b", row))


def decisions() -> list[Path]:
    return sorted((DOCS / "decisions").glob("[0-9]*.md"))


def title_and_status(record: Path) -> tuple[str, str, str]:
    """Return the number and title of a decision, and the status below them; missing parts are empty."""
    found = re.match(r"# (\d+) (.+)\n(?:\nStatus: (.+)\n\n)?", record.read_text(encoding="utf-8"))
    number, title, status = found.groups(default="") if found else ("", "", "")
    return number, title, status


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as GitHub and the site make them."""
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    plain = (re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in HEADING.findall(text))
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in plain}


def _literals(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a module except docstrings."""
    nodes = list(ast.walk(tree))
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    yield from (node for node in nodes if id(node) not in docstrings)


def _message(node: ast.AST) -> str:
    """Return the text of a literal, without backticks and with `…` for its values; empty for other nodes."""
    match node:
        case ast.Constant(value=str(text)):
            shown = text
        case ast.JoinedStr(values=parts):
            shown = "".join(map(_part, parts))
        case _:
            return ""
    return re.sub(r"…( ?…)+", "…", shown.replace("`", ""))


def _part(part: ast.expr) -> str:
    match part:
        case ast.Constant(value=value):
            return str(value)
        case ast.FormattedValue(value=ast.Name(id="MAIN_FILE")):
            return MAIN_FILE
    return "…"


def _keys(schema: object) -> set[str]:
    """Return the keys that a schema lists, at every depth."""
    match schema:
        case dict():
            own = schema.get("properties")
            return {*(own if isinstance(own, dict) else ()), *(key for one in schema.values() for key in _keys(one))}
        case list():
            return {key for one in schema for key in _keys(one)}
    return set()


def _fences(page: Path) -> list[tuple[str, str]]:
    """Return the indent and the language of each block that begins in a page."""
    return re.findall(r"(?m)^( *)```(.*)$", page.read_text(encoding="utf-8"))[::2]


def _listed(problem: str, found: list[str]) -> str:
    return f"{problem}: {', '.join(found)}" if found else ""


def _name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def main() -> int:
    failed = {
        check.__name__.replace("_", " "): found for check, least in CHECKS.items() if (found := wrong(check, least))
    }
    for name, found in failed.items():
        print(f"{name}:", *found, sep="\n  ")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

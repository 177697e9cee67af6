"""The contributors' pages are correct: every file and name in them exists, and the floors are the contract's."""

import importlib
import importlib.util
import re
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest

from tests import ROOT
from tests.scanning import matching

ENGINE = ROOT / "engine/lumen"
ARCHITECTURE = "docs/architecture.md"
PAGES = ("CONTRIBUTING.md", ARCHITECTURE, "docs/python.md", "docs/reliability.md")

SCHEMES = ("http:", "https:", "mailto:", "#")
CODE = re.compile(r"`([^`\n]+)`")
LINK = re.compile(r"\]\(([^)\s#]+)[^)\s]*\)")
BLOCK = re.compile(r"(?m)^ {4}.*$|^```[\s\S]*?^```$|<!-- shape[\s\S]*?<!-- end of shape -->")
FILE = re.compile(r"[\w./-]+(?:\.(?:py|md|svg|toml|ya?ml|json)|/)")
IN_COMMAND = re.compile(r"(?<!\S)((?:tests|scripts|examples|docs)/[\w./-]+)")
NAME = re.compile(r"(?:[A-Za-z]+\.)*_?[A-Za-z]\w*")
PLACEHOLDER = re.compile(r"\b(?:NAME|CODE|FAMILY)\b")
ELSEWHERE = {"ALTextToSpeech", "angleInterpolationBezier", "YAML", "NaN", "assert_never"}
"""Names of NAOqi and of Python."""


def prose(page: str) -> str:
    """Return a page without its blocks of code and the figures that a script writes."""
    return BLOCK.sub("", (ROOT / page).read_text(encoding="utf-8"))


def items(page: str) -> list[str]:
    """Return the numbered items of a page."""
    return re.findall(r"(?m)^\d\. (?:.*\n)(?: {3}.*\n)*", prose(page))


def found(path: str) -> list[Path]:
    """Return the files of the repository or the package that match a page's path; CODE and NAME match any name."""
    pattern = PLACEHOLDER.sub("*", path).rstrip("/")
    return [file for folder in (ROOT, ENGINE) for file in folder.glob(pattern)]


def paths(text: str) -> list[str]:
    return [code for code in CODE.findall(text) if FILE.fullmatch(code)]


def names(text: str) -> Iterator[str]:
    """Yield the words that can only be names of code: dotted, or with a capital or an underscore inside."""
    for code in CODE.findall(text):
        name = code.removesuffix("()").partition("(")[0]
        inner = re.search(r"[a-z]_[a-z]|[a-z][A-Z]|^[A-Z]\w+$|^_", name) or "." in name
        if NAME.fullmatch(name) and inner and not FILE.fullmatch(code) and name not in ELSEWHERE | {"ID"}:
            yield name


@cache
def words() -> frozenset[str]:
    """Every word of the package's and the tests' code."""
    files = [*matching(ENGINE, "**/*.py"), *matching(ROOT / "tests", "**/*.py")]
    return frozenset(word for file in files for word in re.findall(r"\w+", file.read_text(encoding="utf-8")))


def has(name: str) -> bool:
    """Return whether `lumen.x.y` can be imported or read, or all parts of another name occur in the code."""
    if not name.startswith("lumen."):
        return all(part in words() for part in name.split("."))
    where: ModuleType | object = importlib.import_module("lumen")
    for part in name.split(".")[1:]:
        if not hasattr(where, part) and isinstance(where, ModuleType):
            inner = f"{where.__name__}.{part}"
            if importlib.util.find_spec(inner) is None:
                return False
            importlib.import_module(inner)
        where = getattr(where, part, None)
        if where is None:
            return False
    return True


@pytest.mark.parametrize("page", PAGES)
def test_every_file_and_link_of_a_page_is_there(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    assert [path for path in [*paths(prose(page)), *IN_COMMAND.findall(text)] if not found(path)] == []
    links = [link for link in LINK.findall(text) if not link.startswith(SCHEMES)]
    assert [link for link in links if not (ROOT / page).parent.joinpath(link).exists()] == []


@pytest.mark.parametrize("page", PAGES)
def test_every_name_of_a_page_is_in_the_code(page: str) -> None:
    assert sorted({name for name in names(prose(page)) if not has(name)}) == []


def test_the_names_of_a_numbered_item_stand_in_the_files_that_it_names() -> None:
    lost = []
    for item in items(ARCHITECTURE):
        files = [file for path in paths(item) for file in found(path) if file.suffix == ".py"]
        code = set(re.findall(r"\w+", "".join(file.read_text(encoding="utf-8") for file in files)))
        wanted = {part for name in names(item) if not name.startswith("lumen.") for part in name.split(".")}
        lost += [f"{name}: {item[:60]}" for name in sorted(wanted - code) if files]
    assert lost == []


def test_a_name_in_a_file_is_defined_there() -> None:
    placed = re.findall(r"`([\w.]+)` (?:in|of) `(\w+/[\w/]+\.py)`", prose(ARCHITECTURE))
    assert len(placed) > 30
    lost = []
    for name, path in placed:
        text = "".join(file.read_text(encoding="utf-8") for file in found(path))
        if not all(re.search(rf"(?m)^ *(?:(?:class|def) )?{part}\b", text) for part in name.split(".")):
            lost.append(f"{name} in {path}")
    assert lost == []


def test_the_floors_are_those_of_the_contract_in_its_order() -> None:
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    contract = [room.strip().removeprefix("lumen.") for layer in layers for room in layer.split("|")]
    floors = prose(ARCHITECTURE).partition("## The floors")[2].partition("## The features")[0]
    rows = re.findall(r"(?m)^\| (`.*?`) \| [A-Z]", floors)
    assert [room for row in rows for room in CODE.findall(row)] == contract


def test_the_picture_of_the_floors_is_as_drawn_from_the_contract() -> None:
    spec = importlib.util.spec_from_file_location("floors", ROOT / "docs/pictures/floors.py")
    assert spec
    assert spec.loader
    drawing = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(drawing)
    house = drawing.floors((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    drawn = drawing.PICTURE.read_text(encoding="utf-8")
    assert drawn == drawing.picture(house), "run `python docs/pictures/floors.py`"

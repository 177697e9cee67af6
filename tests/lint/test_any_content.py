"""Lint answers any content of a file with diagnostics."""

import json
from copy import deepcopy
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.yaml_reader import parse
from tests.tables import for_each

BASE = read_files(Path(__file__).parent / "base")
FILES = sorted(BASE)
TEXTS = [file for file in FILES if not file.endswith(".xml")]

scalars = st.one_of(
    st.none(), st.booleans(), st.integers(-500, 500), st.floats(), st.text(max_size=8),
    st.sampled_from(["idle", "Stand", "500ms", "context.asked", "#idle", ".inf", "*", "face.x", "HeadYaw"]),
)  # fmt: skip
values = st.recursive(scalars, lambda v: st.lists(v, max_size=3) | st.dictionaries(st.text(max_size=5), v, max_size=3))


def lint(files: dict[str, bytes]) -> None:
    project, diagnostics = check_files(Path("/nowhere"), files)
    assert project is not None or diagnostics
    for diagnostic in diagnostics:
        assert diagnostic.place.line >= 1
        assert diagnostic.place.column >= 1
        assert diagnostic.message


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(st.sampled_from(FILES), st.binary(max_size=200))
def test_random_bytes(file: str, content: bytes) -> None:
    lint({**BASE, file: content})


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(TEXTS), st.data())
def test_a_file_cut_anywhere(file: str, data: st.DataObject) -> None:
    lint({**BASE, file: BASE[file][: data.draw(st.integers(0, len(BASE[file])))]})


@pytest.mark.slow
@settings(max_examples=80, deadline=None)
@given(st.sampled_from(TEXTS), st.data())
def test_a_line_gone_doubled_or_indented(file: str, data: st.DataObject) -> None:
    lines = BASE[file].split(b"\n")
    at = data.draw(st.integers(0, len(lines) - 1))
    indented = [b"  " + lines[at]]
    lines[at : at + 1] = data.draw(st.sampled_from([[], [lines[at]] * 2, indented, [lines[at].lstrip()]]))
    lint({**BASE, file: b"\n".join(lines)})


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.sampled_from([file for file in FILES if file.endswith(".yaml")]), st.data())
def test_any_value_in_place_of_any_other(file: str, data: st.DataObject) -> None:
    """A random value replaces another one; the file is then written as JSON, which is YAML too."""
    document, _ = parse(file, BASE[file])
    assert document
    path = data.draw(st.sampled_from(sorted(filter(None, document.spans), key=str)))
    content = node = deepcopy(document.data)
    for step in path[:-1]:
        node = node[step]
    node[path[-1]] = data.draw(values)
    lint({**BASE, file: json.dumps(content).encode("utf-8", "surrogatepass")})


@for_each("file", FILES)
def test_any_file_missing(file: str) -> None:
    lint({name: content for name, content in BASE.items() if name != file})


@pytest.mark.slow
def test_an_alias_bomb_is_too_large() -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 10)]
    _, diagnostics = check_files(Path("/nowhere"), {**BASE, "behaviors/tour.yaml": "\n".join(lines).encode()})
    assert "too-large" in {d.code for d in diagnostics}


@pytest.mark.slow
@pytest.mark.parametrize("depth", [40, 95, 5_000])
def test_states_nested_without_end(depth: int) -> None:
    text = "states: {a: " * depth + "{}" + "}" * depth
    lint({**BASE, "behaviors/tour.yaml": text.encode()})
    lint({**BASE, "motions/wave.yaml": ("keyframes: [{" * depth + "}]" * depth).encode()})
    lint({**BASE, "schemas/messages/face.schema.json": ('{"items":' * depth + "{}" + "}" * depth).encode()})


def test_a_file_of_something_else_altogether_is_not_told_key_by_key() -> None:
    content = "".join(f"key{i}: {i}\n" for i in range(2_000)).encode()
    _, found = check_files(Path("/nowhere"), {**BASE, "motions/wave.yaml": content})
    told = [d for d in found if d.place.file == "motions/wave.yaml"]
    assert {d.code for d in told} == {"missing-key", "unknown-key"}
    assert len(told) < 60
    assert any("more" in related.message for d in told for related in d.related)

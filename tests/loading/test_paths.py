"""Values of a document by path, and data with another value at a path."""

import pytest

from lumen.language.json_paths import schema_at, value_at, values_in, with_value
from lumen.project.document import Document

DATA = {"states": {"idle": {"do": [{"say": "Hello"}]}}}


def test_a_value_is_found_through_maps_and_lists() -> None:
    assert Document("a.yaml", DATA).value(("states", "idle", "do", 0, "say")) == "Hello"
    assert Document("a.yaml", DATA).value(()) is DATA


@pytest.mark.parametrize("path", [("gone",), ("states", "idle", "do", 1), ("states", "idle", "do", 0, "say", "deeper")])
def test_a_missing_value_raises_or_is_none(path: tuple[str | int, ...]) -> None:
    document = Document("a.yaml", DATA)
    assert document.find(path) is None
    with pytest.raises((KeyError, IndexError, TypeError)):
        document.value(path)


def test_what_no_map_leads_to_is_none() -> None:
    body = {"face": {"x": 0.5}}
    assert value_at(body, ("face", "x")) == 0.5
    assert [value_at(body, path) for path in (("face", "y"), ("face", "x", "deeper"), ("gone", "x"))] == [None] * 3


def test_a_schema_is_followed_through_its_properties() -> None:
    schema = {"properties": {"face": {"properties": {"x": {"type": "number"}}}}}
    assert schema_at(schema, ("face", "x")) == {"type": "number"}
    assert schema_at(schema, ("face", "y")) is None
    assert schema_at(True, ("face",)) is None


def test_another_value_at_a_path_leaves_the_data_as_it_was() -> None:
    before = {"visitor": {"name": "Budi"}, "tries": 1}
    assert with_value(before, ("visitor", "name"), "Sri") == {"visitor": {"name": "Sri"}, "tries": 1}
    assert with_value(before, ("tries", "left"), 2) == {"visitor": {"name": "Budi"}, "tries": {"left": 2}}
    assert with_value(before, (), None) is None
    assert before == {"visitor": {"name": "Budi"}, "tries": 1}


def test_all_values_are_found_at_any_depth() -> None:
    found = list(values_in(DATA))
    assert found[0] is DATA
    assert {"say": "Hello"} in found
    assert "Hello" in found
    assert len(found) == 6

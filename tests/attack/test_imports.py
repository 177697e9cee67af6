"""`lumen import` loses nothing silently: each small change to a file is in the result or is reported."""

from random import Random

import pytest

from lumen.features.formats_motion import webots
from lumen.project.formats.importers import format_tables
from tests.attack.changes import CHANGERS, changed, normal
from tests.attack.files import FOREIGN
from tests.attack.silence import Importer, attack_imports, passes_silently, samples
from tests.tables import for_each


@for_each("ending", sorted(FOREIGN))
def test_a_seed_determines_the_change(ending: str) -> None:
    text = normal(ending, FOREIGN[ending])
    first, again = (changed(Random(3), ending, text) for _ in range(2))
    assert first == again
    assert first is not None
    assert first.text != text


def test_each_change_is_in_the_result_or_reported() -> None:
    found = attack_imports(range(100))
    assert not found.troubles
    assert set(found.tried) == set(CHANGERS)
    assert set(found.outcomes) == {"in the result", "listed", "refused"}


@pytest.mark.rest  # expensive; the first hundred of them are in `make test`
@pytest.mark.slow
@pytest.mark.parametrize("batch", range(4))
def test_each_of_two_thousand_changes_is_in_the_result_or_reported(batch: int) -> None:
    assert not attack_imports(range(500 * batch, 500 * batch + 500)).troubles


def test_an_importer_that_drops_a_value_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(webots, "number", lambda word: None if word == "*" else 0.0)
    assert any("silent" in trouble.text for trouble in attack_imports(range(60), endings={"motion"}).troubles)


def test_a_name_without_meaning_may_change() -> None:
    importer = Importer()
    text = FOREIGN["fis"]
    seeds = (changed(Random(seed), "fis", text) for seed in range(2_000))
    change = next(one for one in seeds if one and "Name='t" in text and "\nName='qt'" in one.text)
    assert change.touched == {("[System]", "Name")}
    assert "Name" in format_tables()[".fis"]["[System]"].meaningless
    assert not passes_silently("fis", change, importer.outcome("fis", text), importer.outcome("fis", change.text))


def test_every_format_has_samples() -> None:
    assert {sample.ending for sample in samples()} == set(CHANGERS)

"""`scripts/shaken.py` plans its runs and lists the failures; its tests run in random order."""

import random
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from scripts import shaken

from tests import shuffled


def item(name: str, *, ordered: bool = False) -> Any:
    marks = {"ordered": pytest.mark.ordered.mark} if ordered else {}
    return SimpleNamespace(nodeid=name, get_closest_marker=marks.get)


FILES = [item(f"tests/a/test_{file}.py::test_{n}") for file in "xyz" for n in range(5)]


def test_the_same_seed_gives_the_same_order_and_another_another() -> None:
    orders = [[one.nodeid for one in shuffled.shuffled(FILES, random.Random(seed))] for seed in (3, 3, 4)]
    assert orders[0] == orders[1] != orders[2]
    assert sorted(orders[0]) == [one.nodeid for one in FILES]


def test_a_file_stays_together_and_one_that_is_ordered_as_it_is() -> None:
    ordered = [item(f"tests/a/test_o.py::test_{n}", ordered=True) for n in range(5)]
    for seed in range(20):
        found = shuffled.shuffled([*FILES, *ordered], random.Random(seed))
        files = [shuffled.file_of(one) for one in found]
        assert len({at for at, file in enumerate(files) if file != files[at - 1]}) == 4
        assert [one for one in found if one in ordered] == ordered


@pytest.mark.parametrize(("mark", "real"), [("process", True), ("broker", True), ("browser", True), ("physics", False)])
def test_what_has_a_process_a_broker_or_a_browser_is_real(mark: str, real: bool) -> None:
    one: Any = SimpleNamespace(get_closest_marker={mark: "there"}.get)
    assert shuffled.is_real(one) is real


def test_eight_runs_quiet_eight_crowded_and_four_on_half_a_core() -> None:
    plans = shaken.planned(shaken.USUAL, 100)
    assert [plan.condition for plan in plans] == ["quiet"] * 8 + ["crowded"] * 8 + ["half"] * 4
    assert [plan.seed for plan in plans] == list(range(100, 120))


@pytest.mark.parametrize(
    ("words", "counts"),
    [
        ("", {"quiet": 8, "crowded": 8, "half": 4}),
        ("--only-real --suite test", {"quiet": 0, "crowded": 0, "half": 30}),
        ("--half 2", {"quiet": 0, "crowded": 0, "half": 0}),
    ],
)
def test_the_runs_that_nobody_counts(words: str, counts: dict[str, int]) -> None:
    assert shaken.usual(shaken.parsed(words.split())) == counts


def test_the_words_for_pytest_are_handed_on() -> None:
    arguments = shaken.parsed(["--suite", "test", "--only-real", "--half", "1", "--", "tests/buses", "-k", "stop"])
    assert shaken.selection(arguments) == ["--suite", "test", "--only-real", "tests/buses", "-k", "stop"]


def test_what_failed_is_listed_with_how_often_and_the_seeds(tmp_path: Path) -> None:
    def run(condition: str, seed: int, *failed: str) -> shaken.Run:
        return shaken.Run(condition, seed, 9, frozenset(failed), 1.0, 2.0, 0, tmp_path)

    runs = [run("quiet", 1), run("half", 2, "a::b"), run("half", 3, "a::b", "a::c"), run("crowded", 4, "a::b")]
    assert shaken.summary(runs) == [
        "a::b",
        "    half: 2 of 2 runs, seeds 2, 3",
        "    crowded: 1 of 1 runs, seeds 4",
        "a::c",
        "    half: 1 of 2 runs, seeds 3",
    ]
    assert shaken.summary(runs[:1]) == ["no test failed in 1 runs"]


def test_a_run_without_a_failed_test_that_fails_says_why() -> None:
    assert shaken.meaning(5) == "no tests collected"
    assert shaken.meaning(-9) == "exit code -9"


def test_outcomes_are_read_whole_and_cut(tmp_path: Path) -> None:
    file = tmp_path / "outcomes"
    writer = shuffled.Outcomes(file)
    for name, when, outcome, text in (
        ("a::b[x@y]@tests/a", "call", "passed", ""),
        ("a::c", "teardown", "failed", "E   it was 7"),
        ("a::d", "setup", "passed", ""),
    ):
        report: Any = SimpleNamespace(
            nodeid=name, when=when, outcome=outcome, failed=outcome == "failed", longreprtext=text
        )
        writer.pytest_runtest_logreport(report)
    assert shaken.read(file) == (1, {"a::c"})
    assert '"a::b[x@y]"' in file.read_text("utf-8")
    assert '["a::c", "failed", "E   it was 7"]' in file.read_text("utf-8")
    with file.open("a") as more:
        more.write('["a::e", "fai')
    assert shaken.read(file) == (1, {"a::c"})


@pytest.mark.parametrize(
    ("files", "limited"), [(("cpu.shares", "cpu.cfs_quota_us"), True), (("cpu.weight", "cpu.max"), True), ((), False)]
)
def test_a_group_has_the_weight_of_its_workers_and_at_most_half_a_core(
    tmp_path: Path, files: tuple[str, ...], limited: bool
) -> None:
    for file in files:
        (tmp_path / file).write_text("")
    group = shaken.Group.__new__(shaken.Group)
    group.folders = [tmp_path]
    group.weigh(2)
    assert group.limit() is limited
    wanted = {"cpu.shares": "2048", "cpu.cfs_quota_us": "50000", "cpu.weight": "200", "cpu.max": "50000 100000"}
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {file: wanted[file] for file in files}

"""Stored results are used again for the same content only."""

from pathlib import Path
from typing import Any

import pytest

from lumen.lint import check_files
from lumen.project import built_file as reading
from lumen.project import memoization as recollection
from lumen.project import motions
from lumen.project.files import read_files
from lumen.project.memoization import memoize
from tests import ROOT

BASE = read_files(ROOT / "tests/lint/base")
NOD = b"keyframes: [{at: 1s, joints: {HeadPitch: 0.1}}, {at: 2s, joints: {HeadPitch: 0}}]\n"
TURNS = {
    "motions/wave.yaml": (b"at: 1s", b"at: 600ms"),
    "models/tiny.yaml": (b"speed: 800", b"speed: 80"),
    "lumen.yaml": (b"story: hello", b"story: helo"),
    "behaviors/tour.yaml": (b"onError: idle", b"onError: idel"),
}


def test_equal_input_is_answered_from_memory_and_other_input_anew() -> None:
    made = []

    def make() -> int:
        made.append(1)
        return len(made)

    assert [memoize("slot", given, make) for given in ("a", "a", "b", "b", "a")] == [1, 1, 2, 2, 3]


def test_values_that_were_equal_once_are_not_compared_in_depth_again() -> None:
    compared = []

    class Deep:
        def __eq__(self, other: object) -> bool:
            compared.append(other)
            return isinstance(other, Deep)

        __hash__ = None  # type: ignore[assignment]

    read_anew = [(Deep(),), (Deep(),)]
    for given in (read_anew[0], read_anew[1], read_anew[1], read_anew[1]):
        memoize("slot", given, int)
    assert len(compared) == 1


def test_memory_does_not_grow_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recollection, "MAX_MEMOIZED", 3)
    monkeypatch.setattr(recollection, "_last", {})
    for i in range(10):
        memoize(("slot", i), i, int)
    assert len(recollection._last) <= 3


@pytest.mark.parametrize("file", TURNS)
def test_lint_says_the_same_with_and_without_memory(file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    old, new = TURNS[file]
    assert old in BASE[file]
    wrong = {**BASE, file: BASE[file].replace(old, new)}
    remembered = [check_files(Path(), files)[1] for files in (BASE, wrong, wrong, BASE)]
    for files, found in zip((BASE, wrong, wrong, BASE), remembered, strict=True):
        monkeypatch.setattr(recollection, "_last", {})
        assert check_files(Path(), files)[1] == found
    assert remembered[1]
    assert not remembered[3]


@pytest.mark.parametrize(
    ("file", "old", "new", "motions_built"),
    [
        ("behaviors/stories/hello.yaml", b"title: ", b"title: Oh, ", []),
        ("behaviors/tour.yaml", b"onError: idle", b"onError: idel", []),
        ("motions/wave.yaml", b"at: 1s", b"at: 600ms", ["wave", "waves"]),
        ("models/tiny.yaml", b"speed: 800", b"speed: 801", ["nod", "wave", "waves"]),
        ("models/tiny.yaml", b"units", b"# its body\nunits", []),
    ],
)
def test_only_what_a_change_touches_is_read_again(
    file: str, old: bytes, new: bytes, motions_built: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    files = {**BASE, "motions/waves.yaml": b"keyframes: [{play: wave}]\n", "motions/nod.yaml": NOD}
    assert old in files[file]
    check_files(Path(), files)
    read, built = list[str](), list[str]()
    reader, builder = reading._read, motions.build_motion

    def reads(file: str, *given: Any) -> Any:
        read.append(file)
        return reader(file, *given)

    def builds(*given: Any, name: str, **more: Any) -> Any:
        built.append(name)
        return builder(*given, name=name, **more)

    monkeypatch.setattr(reading, "_read", reads)
    monkeypatch.setattr(motions, "build_motion", builds)
    check_files(Path(), {**files, file: files[file].replace(old, new, 1)})
    assert read == [file]
    assert sorted(built) == motions_built

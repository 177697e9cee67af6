"""Tables of small cases: one test that goes through all rows, and lists every one that fails.

`@for_each` accepts what `pytest.mark.parametrize` accepts, without marks. It is for rows that cost little. Cases that
take half a second, start a process or need a fixture of their own are parametrized, so that workers share them. Of
pytest's own fixtures each row has `tmp_path`, `monkeypatch` and `capsys` as if it were the only one.
"""

import functools
import inspect
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from traceback import extract_tb
from typing import Any

import pytest

from tests import ROOT

SHOWN = 20
"""The number of failures that are described; of further ones only the names are printed."""


@dataclass(frozen=True)
class Row:
    """A case: its name in a list of failures, and its arguments."""

    name: str
    given: dict[str, Any]


Ids = Iterable[str] | Callable[[Any], object] | None


class CasesFailedError(AssertionError):
    """The list of all failed cases, raised from the first failure."""


def for_each(names: str | Sequence[str], cases: Iterable[Any], ids: Ids = None) -> Callable[[Callable[..., None]], Any]:
    """Turn a test of one case into a test of all `cases`; further fixtures are passed to each of them.

    Stacked like `parametrize`, it runs every combination.
    """
    keys = [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names)
    listed = ids if ids is None or callable(ids) else list(ids)
    rows = [_row(keys, case, listed, number) for number, case in enumerate(cases)]
    if not rows:
        raise ValueError(f"a table of {', '.join(keys)} without a case: it would prove nothing")

    def over(test: Callable[..., None]) -> Callable[..., None]:
        inner, within = (test.__wrapped__, test.rows) if hasattr(test, "rows") else (test, [Row("", {})])

        @functools.wraps(inner)
        def every(**fixtures: Any) -> None:
            __tracebackhide__ = True
            check(
                (row.name, functools.partial(_run, inner, row.given, fixtures, str(number)))
                for number, row in enumerate(every.rows)  # type: ignore[attr-defined]
            )

        every.rows = [_both(one, two) for two in rows for one in within]  # type: ignore[attr-defined]
        signature = inspect.signature(test)
        left = [part for name, part in signature.parameters.items() if name not in keys]
        every.__signature__ = signature.replace(parameters=left)  # type: ignore[attr-defined]
        return every

    return over


def check(cases: Iterable[tuple[str, Callable[[], object]]]) -> None:
    """Run the check of every named case; raise one error that lists all failures."""
    __tracebackhide__ = True
    count, failed = 0, []
    for name, one in cases:
        count += 1
        try:
            one()
        except (Exception, pytest.fail.Exception) as error:
            failed.append((name, error))
    assert count, "a table without a case proves nothing"
    if failed:
        listed = [f"- {name}: {_sentence(error)}" for name, error in failed[:SHOWN]]
        listed += [f"- {name}" for name, _ in failed[SHOWN:]]
        raise CasesFailedError("\n".join([f"{len(failed)} of {count} cases fail:", *listed])) from failed[0][1]


def _run(test: Callable[..., None], given: dict[str, Any], fixtures: dict[str, Any], number: str) -> None:
    """Run one row with a folder, patches and captured output that no other row has seen."""
    own = dict(fixtures)
    if "tmp_path" in own:
        own["tmp_path"] /= number
        own["tmp_path"].mkdir()
    if "capsys" in own:
        own["capsys"].readouterr()
    with pytest.MonkeyPatch.context() as patch:
        if "monkeypatch" in own:
            own["monkeypatch"] = patch
        test(**given, **own)


def _row(keys: Sequence[str], case: Any, ids: Sequence[str] | Callable[[Any], object] | None, number: int) -> Row:
    named = None
    if isinstance(case, type(pytest.param())):
        assert not case.marks, "a row has no marks: parametrize the test"
        named, values = case.id, case.values
    else:
        values = (case,) if len(keys) == 1 else tuple(case)
    if named is None and ids is not None:
        named = "-".join(str(ids(value) or value) for value in values) if callable(ids) else ids[number]
    if named is None:
        named = "-".join(getattr(value, "__name__", None) or str(value) for value in values)
    return Row(named if len(named) <= 100 else f"{named[:99]}…", dict(zip(keys, values, strict=True)))


def _both(one: Row, two: Row) -> Row:
    return Row(f"{one.name}-{two.name}" if one.name else two.name, one.given | two.given)


def _sentence(error: BaseException) -> str:
    """Return the error's words and the line of the tests that raised it."""
    words = str(error).strip() if isinstance(error, AssertionError) else f"{type(error).__name__}: {error}".strip()
    places = list(_places(error))
    return "\n  ".join([*words.splitlines(), *(f"({place})" for place in places[-1:])])


def _places(error: BaseException) -> Iterator[str]:
    root = ROOT
    for frame in extract_tb(error.__traceback__):
        path = Path(frame.filename)
        if path.is_relative_to(root / "tests") and path != Path(__file__):
            yield f"{path.relative_to(root)}:{frame.lineno}"

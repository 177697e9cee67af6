"""`# lumen: ignore[CODE] reason`: findings that it hides, findings that it can't, and its own mistakes."""

from pathlib import Path

from lumen.lint import check_files
from lumen.lint.codes import families
from lumen.project.files import read_files
from tests.tables import for_each

BASE = read_files(Path(__file__).parent / "pages/base")
HEAD = "states:\n  idle:\n    on: {touched: awake}\n"


def lint(awake: str) -> list[str]:
    """Return lint's findings in a behaviour with this second state, with lines counted from it."""
    files = BASE | {"behaviors/tour.yaml": (HEAD + awake).encode()}
    return [f"{d.place.line - 3}:{d.place.column} {d.code}" for d in check_files(Path("/nowhere"), files)[1]]


@for_each(
    ("awake", "found"),
    [
        ("  awake:\n    entry: {raise: hi}\n    after: {20s: idle}\n", ["2:20 unused-event"]),
        ("  awake:\n    entry: {raise: hi} # lumen: ignore[unused-event] soon\n    after: {20s: idle}\n", []),
        ("  awake:\n    # lumen: ignore[unused-event] soon\n    entry: {raise: hi}\n    after: {20s: idle}\n", []),
        ("  awake:\n    #lumen:ignore[unused-event]soon\n\n    # x\n    entry: {raise: hi}\n", []),
        (
            "  awake:\n    entry: {raise: hi} # lumen: ignore[unused-event]\n",
            ["2:24 ignore-without-reason"],
        ),
        (
            "  awake:\n    entry: {raise: hi} # lumen: ignore[unused-event, no-effect] soon\n",
            ["2:54 unused-ignore"],
        ),
        ("  awake:\n    entry: {raise: hi} # lumen: ignore soon\n", ["2:20 unused-event", "2:24 unknown-code"]),
        ("  awake: {} # lumen: ignore[] soon\n", ["1:13 unknown-code"]),
        ("  awake: {} # lumen: ignore[unused-evnt] soon\n", ["1:29 unknown-code"]),
        (
            "  awake:\n    onDone: idle # lumen: ignore[never-done] soon\n",
            ["2:5 never-done", "2:34 ignored-error"],
        ),
        (
            "  awake:\n    onDone: idle\n    exit: {log: x} # lumen: ignore[unused-event] perhaps\n",
            ["2:5 never-done"],
        ),
        ('  awake:\n    entry: {log: "a # lumen: ignore[unused-event] b"}\n', []),
        ("  awake:\n    entry:\n      log: |\n        a\n        # lumen: ignore[unused-event] b\n", []),
        ("  awake:\n    entry: {log: x}\n    # a word on lumen: ignore[unused-event] is no comment\n", []),
    ],
)
def test_what_a_comment_hides(awake: str, found: list[str]) -> None:
    about = {"unused-event", "never-done", *families()["comments"]}
    assert [line for line in lint(awake) if line.split()[1] in about] == found

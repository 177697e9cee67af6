"""Faults of a small exhibition: each function breaks a copy of it."""

from collections.abc import Callable, Mapping
from pathlib import Path

MAIN, BEHAVIOR, MOTION = "lumen.yaml", "behaviors/hello.yaml", "motions/wave.yaml"
STORY = "behaviors/stories/visitor.yaml"

Mishap = Callable[[Path], object]


def _replaced(file: str, old: str, new: str) -> Mishap:
    def replace(project: Path) -> None:
        text = (project / file).read_text("utf-8")
        assert old in text, f"{file} has no `{old}`"
        (project / file).write_text(text.replace(old, new, 1), "utf-8")

    return replace


def _written(file: str, content: bytes) -> Mishap:
    return lambda project: (project / file).write_bytes(content)


def _added(file: str, text: str) -> Mishap:
    return lambda project: (project / file).write_text((project / file).read_text("utf-8") + text, "utf-8")


def _deleted(file: str) -> Mishap:
    return lambda project: (project / file).unlink()


def _folder_instead(file: str) -> Mishap:
    def put(project: Path) -> None:
        (project / file).unlink()
        (project / file).mkdir()

    return put


def _loop_of_links(file: str) -> Mishap:
    def link(project: Path) -> None:
        (project / file).unlink()
        (project / file).symlink_to((project / file).name)

    return link


MISHAPS: Mapping[str, Mishap] = {
    "nothing": lambda _: None,
    "main-syntax": _replaced(MAIN, "languages: [en]", "languages: [en"),
    "main-empty": _written(MAIN, b""),
    "main-unknown-key": _added(MAIN, "sterio: loud\n"),
    "main-wrong-type": _replaced(MAIN, "languages: [en]", "languages: 3"),
    "main-later-vocabulary": _added(MAIN, "lumen: 99\n"),
    "main-missing-behavior": _replaced(MAIN, "behavior: hello", "behavior: hallo"),
    "main-missing-hall": _replaced(MAIN, "hall: hall.xml", "hall: hal.xml"),
    "main-unknown-model": _replaced(MAIN, "model: nao", "model: nao7"),
    "main-missing": _deleted(MAIN),
    "behavior-syntax": _replaced(BEHAVIOR, "states:", "states: {"),
    "behavior-unknown-key": _replaced(BEHAVIOR, "onDone: waiting", "ondone: waiting"),
    "behavior-missing": _deleted(BEHAVIOR),
    "behavior-missing-state": _replaced(BEHAVIOR, "onDone: waiting", "onDone: wating"),
    "behavior-missing-motion": _replaced(BEHAVIOR, "play: wave", "play: wavee"),
    "behavior-expression": _replaced(BEHAVIOR, "heard(event.data.result, 'bye')", "heard(event.data.result, 'bye'"),
    "behavior-key-twice": _replaced(BEHAVIOR, "  waiting: {", "  waiting: {on: {face: greeting}}\n  waiting: {"),
    "behavior-wrong-type": _replaced(BEHAVIOR, "after: {30s: waiting}", "after: 30s"),
    "behavior-no-utf-8": _written(BEHAVIOR, b"states: {caf\xe9: {}}\n"),
    "behavior-a-folder": _folder_instead(BEHAVIOR),
    "behavior-a-loop-of-links": _loop_of_links(BEHAVIOR),
    "motion-missing": _deleted(MOTION),
    "motion-beyond-limits": _replaced(MOTION, "keyframes:", "keyframes: 7 #"),
    "story-broken": _replaced(STORY, "visitor: arrives", "visiter: arrives"),
    "run-folder-a-file": _written(".lumen", b"no folder"),
}
"""Faults by name. None depends on the rights of the user."""

"""Speech: languages that are missing, or that the project does not speak."""

from collections.abc import Iterable, Mapping
from typing import Any

from lumen.language.actions import SayText
from lumen.language.commands import Language
from lumen.language.diagnostics import Path, did_you_mean
from lumen.language.machines import Machine
from lumen.loading.draft import Draft
from lumen.loading.source import Report
from lumen.rules.finding import find, value_at
from lumen.rules.walk import sites


def check(draft: Draft) -> None:
    """Report what is said in too few languages, or in one that lumen.yaml does not name."""
    if draft.settings is None or draft.main is None or not draft.settings.languages:
        return
    if any(path[:1] == ("languages",) for path in draft.main.pruned):
        return
    speech = _Speech(draft.settings.languages, draft.main.lost)
    for name, machine in draft.behaviors.items():
        speech.behavior(machine, draft.report("behaviors", name))
    for name, motion in draft.motions.items():
        report = draft.report("motions", name)
        for cue in motion.cues:
            if cue.kind == "say" and isinstance(cue.value, Mapping):
                speech.texts(report, cue.where, cue.value)
    for name, story in draft.stories.items():
        report = draft.report("behaviors/stories", name)
        if story.language:
            speech.known(report, ("language",), story.language)


class _Speech:
    def __init__(self, languages: tuple[str, ...], lost: Iterable[str]) -> None:
        self.languages, self.lost = languages, frozenset(lost)

    def behavior(self, machine: Machine, report: Report) -> None:
        for site in sites(machine):
            match site.step.action:
                case SayText(texts):
                    self.texts(report, (*site.step.where, "say"), texts)
                case Language(language):
                    self.known(report, (*site.step.where, "language"), language)
        for name, phrases in machine.phrases.items():
            self.each(report, ("phrases", name), phrases)
        for table, rows in machine.answers.items():
            for i, row in enumerate(rows):
                self.each(report, ("answers", table, i, "phrases"), row.phrases)
                if isinstance(row.value, Mapping) and set(row.value) & set(self.languages):
                    self.texts(report, ("answers", table, i, "value"), row.value)

    def texts(self, report: Report, path: Path, texts: Mapping[str, Any]) -> None:
        """What is said in several languages should be said in all."""
        self.each(report, path, texts)
        said = {*texts, *_written(report, path)}
        missing = [language for language in self.languages if language not in said]
        if missing and said.isdisjoint(("", "any")):
            message = f"this is not said in {_listed(missing)}"
            find(report, "missing-language", path, message, f"write `{missing[0]}:` and the text beside it", key=True)

    def each(self, report: Report, path: Path, languages: Iterable[str]) -> None:
        for language in languages:
            if language:
                self.known(report, (*path, language), language, key=True)

    def known(self, report: Report, path: Path, language: str, *, key: bool = False) -> None:
        if language not in self.languages and language not in self.lost:
            hint = did_you_mean(language, self.languages, "it speaks")
            find(report, "unknown-language", path, f"the project does not speak `{language}`", hint, key=key)


def _written(report: Report, path: Path) -> set[str]:
    """The languages of a text as the file has them, those of broken texts too."""
    node = value_at(report, path)
    gone = {str(lost[-1]) for lost in report.pruned if lost[:-1] == path}
    return gone.union(node if isinstance(node, dict) else ())


def _listed(names: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)

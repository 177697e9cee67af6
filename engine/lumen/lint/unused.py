"""Declarations that are never used, and names that differ only in case."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

from lumen.expressions import expression_findings
from lumen.expressions.expression_findings import UNKNOWN_STATE
from lumen.language.actions import context_key
from lumen.language.controllers import ControllerDefinition
from lumen.language.diagnostics import INFO, WARNING, Code, NodePath, has_errors, nearest
from lumen.language.folders import FUNCTIONS_FOLDER
from lumen.language.json_paths import values_in
from lumen.language.machines import MachineDefinition
from lumen.language.properties import conditions_of
from lumen.language.stories import Expect
from lumen.language.verbs import names_in
from lumen.lint.events import UNUSED_EVENT, descriptors, hears
from lumen.lint.naming import Named, heard_rows, named_in
from lumen.lint.walk import action_sites, expression_sites
from lumen.lint.word_tables import word_tables
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.project_folders import WORDS_FOLDER
from lumen.talk.speech import TABLES, WORD_LISTS

SAME_BUT_CASE = Code("same-but-case", "references", WARNING, "two names differ only in capital letters")
UNUSED_ANSWERS = Code("unused-answers", "references", WARNING, "no expression looks up a table of answers")
UNUSED_CONTEXT_KEY = Code("unused-context-key", "references", WARNING, "a key of the context is never read")
UNUSED_FILE = Code("unused-file", "references", INFO, "nothing uses a motion, behaviour or controller")
UNUSED_FUNCTION = Code("unused-function", "references", INFO, "no expression calls a function of the project")
UNUSED_LIST = Code("unused-list", "references", WARNING, "nothing uses a list")
UNUSED_PHRASES = Code("unused-phrases", "references", WARNING, "nothing uses a group of phrases")
UNUSED_WORDS = Code("unused-words", "references", WARNING, "no behaviour uses a words file")


_ASKED = {
    "phrases": ("nothing uses the phrases `{}`", "write `heard(event.data.result, '{}')` in a guard", UNUSED_PHRASES),
    "answers": (
        "nothing uses the answers `{}`",
        "write `lookup(event.data.result, '{}')` in an expression",
        UNUSED_ANSWERS,
    ),
    "lists": ("nothing uses the list `{}`", "write `for: {{each: lists.{}, as: …}}` in a state", UNUSED_LIST),
}
"""For each kind of table, the message and the hint for an unused name, and its code."""

_NO_MEANINGS = {"phrases": WORD_LISTS, "answers": TABLES}
"""Names that Lumen uses to understand sentences, even if no expression names them."""

_EXPRESSION_CODES = {c for c in vars(expression_findings).values() if isinstance(c, Code)} - {UNKNOWN_STATE}


def check(draft: ProjectDraft) -> None:
    """Report unused names, but only if nothing that could use them is broken, and names that differ only in case."""
    sound = set()
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        _alike_inside(machine, report)
        if report.whole and not any(d.code in _EXPRESSION_CODES for d in report.diagnostics):
            sound.add(name)
            _inside(draft, name, machine, report)
    _words(draft, sound)
    for report, phrases, answers, lists in word_tables(draft):
        _say_alike(report, ("phrases",), phrases)
        _say_alike(report, ("answers",), answers)
        _say_alike(report, ("lists",), lists)
    _alike_files(draft)
    if draft.settings and not has_errors(draft.diagnostics):
        _files(draft)
        _functions(draft)


def _inside(draft: ProjectDraft, name: str, machine: MachineDefinition, report: DocumentReport) -> None:
    named = named_in(machine)
    if named.keys is not None:
        _context(machine, report, named.keys | _looked_at(draft, name))
    own = {part: {key for key in getattr(machine, part) if (part, key) not in machine.borrowed} for part in _ASKED}
    _unasked(report, own, [named], _states_of(report), hears=any(heard_rows(machine)))
    waited = set(descriptors(machine))
    for event in machine.events:
        if not (any(hears(d, event) for d in waited) or nearest(event, report.missed)):
            message = f"nothing waits for the event `{event}`"
            hint = "handle it under `on:`, or delete it"
            report(UNUSED_EVENT, ("events", event), message, hint, key=True, root=_states_of(report))


def _words(draft: ProjectDraft, sound: Collection[str]) -> None:
    """Report words files that no behaviour names, and unused names in the other words files."""
    for name, words in draft.own_words.items():
        report, users = draft.report(WORDS_FOLDER, name), [n for n, m in draft.behaviors.items() if name in m.words]
        if not users and report.whole and draft.whole_behaviors:
            message, hint = f"no behaviour uses the words `{name}`", f"write `words: {name}` at the top of a behaviour"
            draft.say(UNUSED_WORDS, report.document.file, message, f"{hint}, or delete the file")
        elif users and all(user in sound for user in users):
            named = [named_in(draft.behaviors[user]) for user in users]
            own = {part: set(getattr(words, part)) for part in _ASKED}
            _unasked(report, own, named, "", hears=any(any(heard_rows(draft.behaviors[user])) for user in users))


def _unasked(
    report: DocumentReport, own: Mapping[str, Collection[str]], named: Sequence[Named], root: str, *, hears: bool
) -> None:
    """Report phrases, answers and lists of a file whose name is in no expression and no row of `hears`.

    Word lists are exempt. With `hears`, a behaviour that knows the file has rows, and the hints suggest writing one.
    """
    texts = {text for each in named for text in each.texts}
    lists = None if any(each.lists is None for each in named) else {n for each in named for n in each.lists or ()}
    for part, (message, hint, code) in _ASKED.items():
        for key in set(own[part]).difference(_NO_MEANINGS.get(part, ())):
            if key not in texts and (part != "lists" or (lists is not None and key not in lists)):
                them = "it" if part == "lists" else "them"
                advice = f"{hint.format(key)}, or delete {them}"
                if hears and part != "lists":
                    advice = f"write `{key}: …` under `hears` of a state, or delete {them}"
                report(code, (part, key), message.format(key), advice, key=True, root=root)


def _context(machine: MachineDefinition, report: DocumentReport, read: Collection[str]) -> None:
    written = {context_key(key) for site in action_sites(machine) for key in getattr(site.step.action, "values", ())}
    for key in report.document.data.get("context") or ():
        if key not in read:
            hint = "use it in an expression, or delete it"
            what = "is set but never read" if key in written else "is declared but never used"
            message, root = f"`{key}` {what}", _states_of(report)
            report(UNUSED_CONTEXT_KEY, ("context", key), message, hint, key=True, root=root)


def _states_of(report: DocumentReport) -> str:
    """Return the root cause of unused names: part of the statechart may be missing. Stories report the same cause."""
    return f"the states of {report.document.file}"


def _looked_at(draft: ProjectDraft, name: str) -> set[str]:
    """Return the context keys that controllers read, or stories of this behaviour expect."""
    main = draft.settings.behavior if draft.settings else ""
    stories = [story for story in draft.stories.values() if (story.behavior or main) == name]
    expected = {
        key
        for story in stories
        for step in story.steps
        if isinstance(step.action, Expect)
        for key in step.action.context
    }
    return expected | {source.key for controller in draft.controllers.values() for source in controller.context_inputs}


def _files(draft: ProjectDraft) -> None:
    """Report files that no other file names."""
    assert draft.settings is not None
    actions = [site.step.action for machine in draft.behaviors.values() for site in action_sites(machine)]
    expected = {
        s.action.played for story in draft.stories.values() for s in story.steps if isinstance(s.action, Expect)
    }
    motions = {name for action in actions for name in names_in(action, "motion")} | expected
    for name in draft.motions:
        motions |= _played(draft.report("motions", name).document.data)
    behaviors = {draft.settings.behavior, *(story.behavior for story in draft.stories.values())}
    behaviors |= {i.behavior for m in draft.behaviors.values() for state in m.states.values() for i in state.invoke}
    controllers = {name for action in actions for name in names_in(action, "controller")}
    used: Mapping[str, tuple[str, Iterable[str], set[Any], str]] = {
        "motions": ("motion", draft.motions, motions, "use it with `play`, or delete the file"),
        "behaviors": ("behaviour", draft.behaviors, behaviors, "use it with `invoke`, or delete the file"),
        "fuzzy": ("controller", draft.controllers, controllers, "use it with `track`, or delete the file"),
    }
    for folder, (what, names, wanted, hint) in used.items():
        for name in names if wanted.intersection(names) else ():  # without any use, the project is still being written
            if name not in wanted and (folder != "fuzzy" or _bound(draft.controllers[name])):
                message = f"nothing uses the {what} `{name}`"
                draft.say(UNUSED_FILE, f"{folder}/{name}.yaml", message, hint)


def _functions(draft: ProjectDraft) -> None:
    """Report functions of the project that no expression calls; a call by another function counts."""
    written = [site.text.shown for machine in draft.behaviors.values() for site in expression_sites(machine)]
    written += [each.shown for story in draft.stories.values() for each in conditions_of(story.properties)]
    written += [function.expression for function in draft.functions.values()]
    for name in draft.functions:
        if not any(re.search(rf"\b{name}\s*\(", source) for source in written if name in source):
            hint = f"call it in an expression, as `{draft.functions[name].signature}`, or delete the file"
            draft.say(UNUSED_FUNCTION, f"{FUNCTIONS_FOLDER}/{name}.yaml", f"nothing calls the function `{name}`", hint)


def _bound(controller: ControllerDefinition) -> bool:
    """Return whether a controller has an effect when `track` switches it on."""
    return bool(controller.output_bindings or controller.signals)


def _played(data: Any) -> set[str]:
    maps = (item for item in values_in(data) if isinstance(item, Mapping))
    return {item["play"] for item in maps if isinstance(item.get("play"), str)}


def _alike_files(draft: ProjectDraft) -> None:
    for file, other in _alike(draft.files):
        message = f"{file} and {other} differ only in capital letters: some computers treat them as one file"
        draft.say(SAME_BUT_CASE, file, message, "rename one of them")
    if draft.settings and draft.main:
        own = [name for name, route in draft.settings.routes.items() if not route.built_in]
        _say_alike(draft.main, ("routes",), own)


def _alike_inside(machine: MachineDefinition, report: DocumentReport) -> None:
    for part in ("context", "events"):
        _say_alike(report, (part,), getattr(machine, part))
    for state in machine.states.values():
        _say_alike(report, (*state.where, "states"), [path.rpartition(".")[2] for path in state.children])


def _say_alike(report: DocumentReport, path: NodePath, names: Iterable[str]) -> None:
    for name, other in _alike(names):
        message = f"`{name}` and `{other}` differ only in capital letters"
        related = [((*path, other), "the other one is here")]
        report(SAME_BUT_CASE, (*path, name), message, "rename one of them", key=True, related=related)


def _alike(names: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Yield each name that differs only in case from an earlier one, with the earlier name."""
    seen: dict[str, str] = {}
    for name in names:
        other = seen.setdefault(name.casefold(), name)
        if other != name:
            yield name, other

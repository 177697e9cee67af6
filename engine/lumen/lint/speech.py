"""Speech: texts in too few languages, or in languages that the project does not speak."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

from lumen.language.actions import SayText
from lumen.language.commands import Language
from lumen.language.diagnostics import ERROR, WARNING, Code, Diagnostic, NodePath, Place, Related, did_you_mean, nearest
from lumen.language.folders import KNOWLEDGE_FOLDER, QUESTIONS_FOLDER, SAYINGS_FOLDER
from lumen.language.language_tags import is_language_tag
from lumen.language.machines import Answer, MachineDefinition
from lumen.lint.lists import is_torn, listed_texts
from lumen.lint.naming import heard_rows, looked_up
from lumen.lint.torn_texts import TORN_TEXT
from lumen.lint.translation import begun, is_empty, language_entries, switched_to
from lumen.lint.walk import action_sites
from lumen.lint.word_tables import WordTables, is_taken, word_tables
from lumen.project.common_words import COMMON_FILE
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.settings import said_at
from lumen.project.torn_texts import quoting, whole_text
from lumen.project.words import ANYHOW
from lumen.talk.speech import TABLES, WORD_LISTS

UNKNOWN_LANGUAGE = Code(
    "unknown-language", "references", ERROR, "a name refers to a language that the project does not speak"
)
SHADOWED_ANSWER = Code(
    "shadowed-answer", "speech", WARNING, "an answer is never given, because an earlier one always is"
)
MISSING_LANGUAGE = Code("missing-language", "speech", WARNING, "a text is missing in one of the project's languages")
UNREACHABLE_LANGUAGE = Code(
    "unreachable-language", "speech", WARNING, "nothing switches to a language that the project speaks"
)


MIN_TEXTS_FOR_LANGUAGE = 4
"""The number of texts from which a language without texts is reported once, rather than for each text."""

MAX_COMPARED_ROWS = 200
"""The maximum number of an answers table's rows that are compared with one another; later ones are not checked."""


def check(draft: ProjectDraft) -> None:
    """Report texts that are missing in a language or empty, and languages that are unknown or unused."""
    if draft.settings is None or draft.main is None or not draft.settings.languages:
        return
    if any(path[:1] == ("languages",) for path in draft.main.pruned):
        return
    silent, few = _silent(draft, draft.settings.languages)
    spoken = tuple(n for n in draft.settings.languages if n not in silent)
    speech = _Speech(spoken, draft.main.lost | silent.keys(), _heard_tables(draft))
    for language, (meant, related) in silent.items():
        there = (*said_at(draft.settings, draft.main, "languages"), draft.settings.languages.index(language))
        hint = f"did you mean `{meant}`?" if meant else f"write the texts in `{language}`, or delete the language"
        message = f"only {few[language]} texts are in `{language}`" if few[language] else f"no text is in `{language}`"
        draft.main.diagnostics.append(_silence(draft.main, there, message, hint, related))
        speech.lost |= {meant}
    for name, machine in draft.behaviors.items():
        speech.behavior(machine, draft.report("behaviors", name))
    for tables in word_tables(draft):
        speech.tables(tables)
        speech.phrases(tables)
    for name, passage in draft.knowledge.items():
        report = draft.report(KNOWLEDGE_FOLDER, name)
        for key, texts in (("questions", passage.questions), ("answer", passage.answer)):
            given = texts, speech.languages, frozenset(speech.lost)
            report.memoize(("speech", report.document.file, key), given, partial(speech.texts, report, (key,), texts))
    for name, questions in draft.questions.items():
        report = draft.report(QUESTIONS_FOLDER, name)
        speech.each(report, ("unanswered",), questions.unanswered)
        for about, texts in questions.asked.items():
            speech.each(report, ("asked", about), texts)
    entries = language_entries(draft)
    for language in speech.languages:
        for report, path in begun(entries, language):
            message = f"this is not translated into `{language}` yet"
            hint = f"translate it and delete TODO; `lumen language check {language}` lists all of these texts"
            report(MISSING_LANGUAGE, path, message, hint, cause=f"to translate into {language}")
    speech.switches(draft, silent)
    for name, motion in draft.motions.items():
        report = draft.report("motions", name)
        for cue in motion.cues:
            if cue.kind == "say" and isinstance(cue.value, Mapping):
                speech.texts(report, cue.where, cue.value)
    for name, story in draft.stories.items():
        report = draft.report("behaviors/stories", name)
        if story.language:
            speech.known(report, ("language",), story.language)
    for name, sayings in draft.sayings.items():
        report = draft.report(SAYINGS_FOLDER, name)
        for where in dict.fromkeys(saying.where[:4] for saying in sayings.sayings):
            speech.known(report, where, str(where[3]), key=True)


def _heard_tables(draft: ProjectDraft) -> set[str]:
    """Return the tables of answers that only rows of `hears` use, in which the longest match wins, not the first row.

    If a behaviour can't be read, every table that the other behaviours do not look up is included.
    """
    heard = {name for machine in draft.behaviors.values() for row in heard_rows(machine) for name in row.names}
    if COMMON_FILE in draft.files and draft.behaviors.keys() != draft.names["behaviors"]:
        heard |= {name for tables in word_tables(draft) for name in tables.answers}
    return {*TABLES, *(heard - looked_up(draft) if heard else ())}


def _silent(
    draft: ProjectDraft, languages: tuple[str, ...]
) -> tuple[dict[str, tuple[str, list[Related]]], dict[str, str]]:
    """Return the languages with hardly any texts, if others have texts, and their share of all texts.

    For each of these languages, the first mapping has the language that was probably meant (else empty), with a place
    of a text in that language. The second mapping has counts such as `2 of 16`, empty if a language has no text at all.
    """
    found: dict[str, Place] = {}
    counts: Counter[str] = Counter()
    count = 0
    for report, where in _spoken(draft):
        written = _written(report, where)
        count += not written or written.isdisjoint(("", "any"))
        for language in written:
            counts[language] += 1
            found.setdefault(language, report.document.place((*where, language), key=True))
    spoken = found.keys() - {"", "any"}
    strangers = sorted(spoken - set(languages))
    begun = {n for n in languages if n in spoken and count >= MIN_TEXTS_FOR_LANGUAGE**2 and 2 * counts[n] < count}
    silent = [language for language in languages if language not in spoken or language in begun]
    near = {language: nearest(language, strangers) if language not in begun else "" for language in silent}
    if len(silent) == len(strangers) == 1 and len(languages) > 1 and not begun:
        near = {silent[0]: strangers[0]}
    if not spoken or (count < MIN_TEXTS_FOR_LANGUAGE and not any(near.values())):
        return {}, {}
    said = {
        language: (meant, [Related(found[meant], f"this text is in `{meant}`")] if meant else [])
        for language, meant in near.items()
    }
    return said, {n: f"{counts[n]} of {count}" if n in begun else "" for n in silent}


def _spoken(draft: ProjectDraft) -> Iterator[tuple[DocumentReport, NodePath]]:
    """Yield the places of texts that the robot says or that are given as answers."""
    for name, machine in draft.behaviors.items():
        said = (s.step.where for s in action_sites(machine) if isinstance(s.step.action, SayText))
        yield from ((draft.report("behaviors", name), (*where, "say")) for where in said)
    for report, _, answers, _ in word_tables(draft):
        for table, rows in answers.items():
            texts = (i for i, row in enumerate(rows) if isinstance(row.value, Mapping))
            yield from ((report, ("answers", table, i, "value")) for i in texts)
    languages = draft.settings.languages if draft.settings else ()
    yield from ((report, path) for report, path, _ in listed_texts(word_tables(draft), languages))


def _silence(report: DocumentReport, path: NodePath, message: str, hint: str, related: list[Related]) -> Diagnostic:
    return MISSING_LANGUAGE.at(report.document.place(path), message, hint, tuple(related))


class _Speech:
    """Checks texts and phrases in some `languages`. Tables of answers in `heard` are left to the rules of `hears`."""

    def __init__(self, languages: tuple[str, ...], lost: Iterable[str], heard: Collection[str]) -> None:
        self.languages, self.lost, self.heard = languages, set(lost), heard

    def behavior(self, machine: MachineDefinition, report: DocumentReport) -> None:
        for button in (button for state in machine.states.values() for button in state.buttons):
            self.texts(report, (*button.where, "label"), button.label)
        for key, value in _mapping_at(report, ("context",)).items():
            where = ("context", key)
            if isinstance(value, Mapping) and set(value) & set(self.languages) and is_torn(report, where, value, ()):
                self.split(report, where, value)
        for site in action_sites(machine):
            match site.step.action:
                case SayText(texts):
                    self.texts(report, (*site.step.where, "say"), texts)
                case Language(language):
                    self.known(report, (*site.step.where, "language"), language)

    def tables(self, tables: WordTables) -> None:
        report = tables.report
        for name, phrases in tables.phrases.items():
            self.each(report, ("phrases", name), phrases)
            self.empty(report, ("phrases", name))
        for table, rows in tables.answers.items():
            if table not in self.heard:
                report.memoize(("late answers", report.document.file, table), rows, partial(_late, report, table, rows))
            for i, row in enumerate(rows):
                self.each(report, ("answers", table, i, "phrases"), row.phrases)
                self.empty(report, ("answers", table, i, "phrases"))
                if isinstance(row.value, Mapping) and set(row.value) & set(self.languages):
                    self.texts(report, ("answers", table, i, "value"), row.value)
        for report, path, texts in listed_texts([tables], self.languages):
            parts = self.split(report, path, texts)
            self.texts(report, path, {language: text for language, text in texts.items() if language not in parts})

    def phrases(self, tables: WordTables) -> None:
        """Report names of phrases that lack a language of the project; names that lack the same language share a cause.

        Word lists, and phrases for every language, are exempt.
        """
        for name, phrases in tables.phrases.items():
            if name in WORD_LISTS:
                continue
            said = {*phrases, *_written(tables.report, ("phrases", name))}
            for language in self.languages if said and said.isdisjoint(("", "any")) else ():
                if language not in said and said <= {*self.languages}:
                    message = f"no phrase of `{name}` is in `{language}`"
                    hint = f"add `{language}: [ … ]` with what visitors say in that language"
                    cause = f"phrases in {language}"
                    tables.report(MISSING_LANGUAGE, ("phrases", name), message, hint, key=True, cause=cause)

    def switches(self, draft: ProjectDraft, silent: Collection[str]) -> None:
        """Report languages that no behaviour switches to, if behaviours switch to other languages."""
        assert draft.main
        switched = switched_to(draft)
        spoken = switched | {story.language for story in draft.stories.values() if story.language}
        reports = [draft.report("behaviors", name) for name in draft.behaviors]
        whole = all(r.whole and not any(d.code == UNKNOWN_LANGUAGE for d in r.diagnostics) for r in reports)
        for i, language in enumerate(self.languages if whole and switched else ()):
            if i and language not in spoken and language not in silent and not _is_missed(draft, language):
                message = f"nothing switches the robot to `{language}`"
                hint = f"write the action `language: {language}` for visitors who ask for it"
                assert draft.settings
                path = (*said_at(draft.settings, draft.main, "languages"), draft.settings.languages.index(language))
                draft.main(UNREACHABLE_LANGUAGE, path, message, hint)

    def texts(self, report: DocumentReport, path: NodePath, texts: Mapping[str, Any]) -> None:
        """Report a text by language that lacks a language, is empty in a language, or has an unknown language."""
        self.each(report, path, texts)
        self.empty(report, path)
        said = {language for language in texts if not _is_rest(report, (*path, language))} | _written(report, path)
        astray = {language for language in self.languages if (*path[:-1], language) in report.pruned}
        if any(language not in self.languages for language in said - {"", "any"}):
            return  # the text was probably meant to be in the missing language
        missing = [language for language in self.languages if language not in said | astray]
        if missing and said.isdisjoint(("", "any")):
            message = f"this text is missing in {_listed(missing)}"
            report(MISSING_LANGUAGE, path, message, f"add `{missing[0]}:` with the text", key=True)

    def split(self, report: DocumentReport, path: NodePath, texts: Mapping[str, Any]) -> set[str]:
        """Report texts that YAML splits at a comma, each once; return the keys that are parts of these texts."""
        wholes = {key: whole_text(report.document, (*path, key), by_language=True) for key in texts}
        for key, whole in wholes.items():
            if whole:
                message = f"`{key}` is not part of the text: it is read as a key"
                cause = f"{report.document.file} {path} {whole}"
                report(TORN_TEXT, (*path, key), message, quoting(whole), key=True, cause=cause)
        return {key for key, whole in wholes.items() if whole}

    def empty(self, report: DocumentReport, path: NodePath) -> None:
        """Report translations without words."""
        for language, text in _mapping_at(report, path).items():
            if language in self.languages and is_empty(text) and not report.broken((*path, language)):
                message = f"this text is empty in `{language}`"
                report(MISSING_LANGUAGE, (*path, language), message, f"write the text in `{language}`", key=True)

    def each(self, report: DocumentReport, path: NodePath, languages: Iterable[str]) -> None:
        for language in languages:
            if language:
                self.known(report, (*path, language), language, key=True)

    def known(self, report: DocumentReport, path: NodePath, language: str, *, key: bool = False) -> None:
        if language not in self.languages and language not in self.lost:
            hint, cause = did_you_mean(language, self.languages, "it speaks"), f"language {language}"
            message = f"the project does not speak `{language}`"
            if key and (whole := whole_text(report.document, path, by_language=not language.isidentifier())):
                hint, cause = quoting(whole), f"{path[:-1]} {whole}"
            elif key and not is_language_tag(language):
                hint += f"; if `{language}` is part of a text, put quotes around the whole text"
            report(UNKNOWN_LANGUAGE, path, message, hint, key=key, cause=cause)


def _written(report: DocumentReport, path: NodePath) -> set[str]:
    """Return the languages of a text as written in the file, including those whose value is broken."""
    gone = {str(lost[-1]) for lost in report.pruned if lost[:-1] == path}
    found = gone.union(_mapping_at(report, path)) - {"gestures", ANYHOW}
    return {language for language in found if not _is_rest(report, (*path, language))}


def _mapping_at(report: DocumentReport, path: NodePath) -> Mapping[str, Any]:
    node = report.document.find(path)
    return node if isinstance(node, dict) else {}


def _is_rest(report: DocumentReport, path: NodePath) -> bool:
    """Return whether a key of a text by language is the rest of a text that YAML has split, instead of a language."""
    name = str(path[-1])
    return bool(whole_text(report.document, path)) or not (is_language_tag(name) or name.isidentifier() or not name)


def _is_missed(draft: ProjectDraft, language: str) -> bool:
    """Return whether a text is reported as missing in that language, because that must be fixed first."""
    found = (d for report in draft.reports.values() for d in report.diagnostics if d.code == MISSING_LANGUAGE)
    return any(f"`{language}`" in diagnostic.message for diagnostic in found)


def _listed(names: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _late(report: DocumentReport, table: str, rows: Sequence[Answer]) -> None:
    """Report rows of an answers table whose phrases all contain phrases of earlier rows, which win."""
    for i, row in enumerate(rows[:MAX_COMPARED_ROWS]):
        phrases = [phrase for texts in row.phrases.values() for phrase in texts]
        takers = [next((j for j in range(i) if is_taken(p, rows[j].phrases)), None) for p in phrases]
        if phrases and None not in takers:
            first = min(j for j in takers if j is not None)
            message = f"this answer is never given: row {first + 1} matches `{phrases[0]}` first"
            related = [(("answers", table, first), "the first row with a matching phrase wins")]
            path = ("answers", table, i, "phrases")
            report(SHADOWED_ANSWER, path, message, f"put this row before row {first + 1}", key=True, related=related)

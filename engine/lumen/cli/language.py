"""`lumen language`: add a language to a project, and list what is not translated."""

import argparse
import json
from pathlib import Path

from lumen.cli.fixing import write
from lumen.cli.tables import table
from lumen.errors import ProjectError, UsageError
from lumen.language.diagnostics import did_you_mean, has_errors
from lumen.language.language_tags import is_language_tag
from lumen.lint import check_files
from lumen.lint.new_language import with_language
from lumen.lint.translation import (
    TO_DO,
    LanguageEntry,
    Untranslated,
    language_entries,
    plain_texts,
    switched_to,
    untranslated,
)
from lumen.project.building import draft
from lumen.project.draft import ProjectDraft
from lumen.project.files import read_files
from lumen.project.running_project import own_project

VERBS = {
    "list": "list the languages of the project, and how much is missing in each",
    "add LANG": f"add an entry in this language to each text and phrase, with {TO_DO}and the words to translate",
    "check [LANG…]": "list what is missing in these languages (default: all); exit code 1 if anything is",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen language` to its parser."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = "\n".join(["what to do:", *(f"  {verb:15} {what}" for verb, what in VERBS.items())])
    parser.add_argument("what", metavar="WHAT", choices=[verb.split()[0] for verb in VERBS], help="see below")
    parser.add_argument("languages", metavar="LANG", nargs="*", help="a language code such as `de`")
    parser.add_argument(
        "--from", dest="source", metavar="LANG", help="add: the language to translate from (default: the first)"
    )
    parser.add_argument("--project", metavar="DIR", help="the project's folder (default: this folder or one above)")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Run `list`, `add` or `check`; return 0, or 1 if `check` finds missing texts.

    Raises ProjectError if the project's files have errors, and UsageError for a language that can't be used.
    """
    root = own_project(options.project)
    files = read_files(root)
    _, diagnostics = check_files(root, files)
    if has_errors(diagnostics):
        raise ProjectError(diagnostics)
    found = draft(files)
    if options.what == "add":
        return _add(options, root, files, found)
    spoken = found.settings.languages if found.settings else ()
    for language in options.languages:
        if language not in spoken:
            raise UsageError(f"the project has no language `{language}`: {did_you_mean(language, spoken, 'it has')}")
    entries = language_entries(found)
    missing = {language: list(untranslated(entries, language)) for language in options.languages or spoken}
    if options.format == "json":
        print(json.dumps({"languages": {name: _said(entries, gaps) for name, gaps in missing.items()}}))
    elif options.what == "list":
        rows = [[name, str(len(entries)), str(len(gaps))] for name, gaps in missing.items()]
        print(table(["language", "texts and phrases", "missing"], rows))
    else:
        _tell(entries, missing)
        same = [report.document.place(path) for report, path in plain_texts(found)] if len(spoken) > 1 else []
        for place in same:
            print(f"{place} is said in all languages: write one text for each language, or leave it if it fits all")
        for language in sorted({*missing} - {*spoken[:1]} - switched_to(found)):
            hint = f"add the action `language: {language}` for visitors who ask for it"
            print(f"{language}: no action switches the robot to this language: {hint}")
    return int(options.what == "check" and any(missing.values()))


def _add(options: argparse.Namespace, root: Path, files: dict[str, bytes], found: ProjectDraft) -> int:
    spoken = found.settings.languages if found.settings else ()
    if len(options.languages) != 1:
        raise UsageError("write `lumen language add LANG`, with a code such as `de`")
    [language] = options.languages
    source = options.source or spoken[0]
    if language in spoken:
        raise UsageError(
            f"the project already has `{language}`: `lumen language check {language}` lists what is missing"
        )
    if not is_language_tag(language):
        raise UsageError(f"`{language}` is not a language code: write two or three lowercase letters, such as `de`")
    if source not in spoken:
        raise UsageError(f"the project has no language `{source}`: {did_you_mean(source, spoken, 'it has')}")
    changed = with_language(found, files, language, source)
    after = {**files, **changed}
    _, diagnostics = check_files(root, after)
    if has_errors(diagnostics):
        errors = [str(d) for d in diagnostics if d.severity.value == "error"]
        raise UsageError(f"`{language}` can't be added, and nothing is written: {errors[0]}")
    write(root, files, changed)
    for file, content in sorted(changed.items()):
        print(f"{file}: {content.count(TO_DO.encode()) - files[file].count(TO_DO.encode())} to translate")
    print(f"Translate the texts that begin with {TO_DO.strip()}; `lumen language check {language}` lists what is left.")
    print(f"The robot speaks it after the action `language: {language}`, or with `lumen run --language {language}`.")
    return 0


def _tell(entries: list[LanguageEntry], missing: dict[str, list[Untranslated]]) -> None:
    for language, gaps in missing.items():
        for place, text in gaps:
            print(f"{place} {language} is missing: {text}")
    for language, gaps in missing.items():
        print(
            f"{language}: "
            + (f"{len(gaps)} of {len(entries)} are missing" if gaps else f"all {len(entries)} are present")
        )


def _said(entries: list[LanguageEntry], gaps: list[Untranslated]) -> dict[str, object]:
    places = [{"file": p.file, "line": p.line, "column": p.column, "text": text} for p, text in gaps]
    return {"texts": len(entries), "missing": places}

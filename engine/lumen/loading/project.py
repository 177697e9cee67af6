"""A whole project: all its files built into a `Draft`, and that into a `Project` where nothing is wrong."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Any, TypeVar

from lumen.language.diagnostics import Severity, has_errors
from lumen.language.machines import Machine
from lumen.language.motions import Motion
from lumen.language.projects import Project
from lumen.loading.behaviors import build_machine
from lumen.loading.bodies import build_body, build_likes
from lumen.loading.controllers import build_controller
from lumen.loading.draft import Draft
from lumen.loading.files import FOLDERS, Unreadable, fingerprint, read_files
from lumen.loading.linking import link
from lumen.loading.messages import ENDING, build_message
from lumen.loading.motions import build_motions
from lumen.loading.packaged import MAIN_FILE
from lumen.loading.recollection import again
from lumen.loading.schema import check_schema
from lumen.loading.settings import build_settings
from lumen.loading.source import Report, parse
from lumen.loading.stories import build_story

__all__ = ["FOLDERS", "MAIN_FILE", "Draft", "assemble", "draft", "read_files"]

T = TypeVar("T")

_KINDS: Mapping[str, str] = {
    "behaviors": "behavior",
    "behaviors/stories": "story",
    "fuzzy": "controller",
    "motions": "motion",
    "models/passages": "motion",
    "models": "body",
}


def draft(files: Mapping[str, bytes]) -> Draft:
    """Everything that can be built from these files; it depends on nothing else and never raises for what they say."""
    found = Draft(files)
    sources = {folder: dict(_sources(found, folder)) for folder in _KINDS}
    if (content := files.get(MAIN_FILE)) is None:
        found.say("missing-file", MAIN_FILE, "there is no lumen.yaml", "`lumen new DIR` makes a project with one")
    elif (main := _read(found, MAIN_FILE, content, "lumen")) is not None:
        found.settings = _built(main[1], lambda: build_settings(*main))
    found.bodies = build_likes(_each(sources["models"], build_body), sources["models"])
    found.behaviors = _each(sources["behaviors"], lambda *a, name: build_machine(*a, name=name, into=Machine))
    found.behaviors = link(
        found.behaviors, {n: found.report("behaviors", n) for n in found.behaviors}, found.names["behaviors"]
    )
    found.stories = _each(sources["behaviors/stories"], build_story)
    found.controllers = _each(sources["fuzzy"], build_controller)
    passages = _motions(found, "models/passages", sources)
    found.bodies = {name: replace(body, passages=tuple(passages.values())) for name, body in found.bodies.items()}
    found.motions = _motions(found, "motions", sources)
    _messages(found)
    torn = {d.place.file for d in found.loose if d.severity is Severity.ERROR}
    for file, report in found.reports.items():
        report.whole = not (report.pruned or file in torn or has_errors(report.diagnostics))
    return found


def assemble(found: Draft, root: str) -> Project:
    """The project, from a draft without errors."""
    settings, body = found.settings, found.body
    assert settings is not None
    assert body is not None
    return Project(
        root=root,
        name=settings.name or PurePosixPath(root.replace("\\", "/")).name,
        robot=settings.robot,
        body=body,
        hall=settings.hall,
        behavior=settings.behavior,
        behaviors=found.behaviors,
        controllers=found.controllers,
        motions=found.motions,
        routes=settings.routes,
        stories=found.stories,
        messages=found.messages,
        languages=settings.languages,
        story=settings.story,
        stage=settings.stage,
        bus=settings.bus,
        patience=settings.patience,
        modules=settings.modules,
        hash=fingerprint(found.files),
        documents={file: report.document for file, report in found.reports.items()},
    )


def _sources(found: Draft, folder: str) -> Iterator[tuple[str, tuple[Any, Report]]]:
    """The data and report of each document of a folder, by name."""
    names = set()
    for file, content in found.files.items():
        path = PurePosixPath(file)
        if str(path.parent) != folder or path.suffix not in (".yaml", ".yml"):
            continue
        if path.suffix == ".yml":
            hint = f"rename it to {path.stem}.yaml, or delete it"
            found.say("not-read", file, "files that end in .yml are not read", hint, Severity.WARNING)
            continue
        names.add(path.stem)
        if (read := _read(found, file, content, _KINDS[folder])) is not None:
            yield path.stem, read
    found.names[folder] = frozenset(names)


def _read(found: Draft, file: str, content: bytes, kind: str) -> tuple[Any, Report] | None:
    """The checked data of one document and its report, None where it can't be read at all."""
    if isinstance(content, Unreadable):
        hint = "put a readable file there, or delete it"
        found.say("unreadable-file", file, f"this can't be read: {content.decode('utf-8', 'replace')}", hint)
        return None
    document, diagnostics = again(("parse", file), content, lambda: parse(file, content))
    found.loose += diagnostics
    if document is None:
        return None
    report = found.reports[file] = Report(document)
    return check_schema(document, kind, report), report


def _each(sources: Mapping[str, tuple[Any, Report]], build: Callable[..., T | None]) -> dict[str, T]:
    built: dict[str, T] = {}
    for name, (data, report) in sources.items():
        item = _built(report, lambda d=data, r=report, n=name: build(d, r, name=n))  # type: ignore[misc]
        if item is not None:
            built[name] = item
    return built


def _motions(found: Draft, folder: str, folders: Mapping[str, Mapping[str, tuple[Any, Report]]]) -> dict[str, Motion]:
    """The motions of a folder, which can be read only where the robot's body is known."""
    sources = folders[folder]
    only = next(iter(found.bodies)) if found.settings is None and len(found.bodies) == 1 else ""
    model = found.settings.model if found.settings else only
    reports = [report for _, report in sources.values()]
    if model not in found.bodies or not reports:
        return {}
    for report in reports:
        report.lost |= found.report("models", model).lost
    given = tuple(found.contents(folder, "models", MAIN_FILE))
    return again(
        (folder,),
        given,
        lambda: _built(reports[0], lambda: build_motions(sources, found.bodies[model])) or {},
        worth=lambda _: not any(report.diagnostics for report in reports),
    )


def _built(report: Report, build: Callable[[], T | None]) -> T | None:
    """What `build` makes; a file may nest more deeply than Python can follow."""
    try:
        return build()
    except RecursionError:
        report("too-large", (), "the file is nested too deeply to be read", hint="use fewer levels")
        return None


def _messages(found: Draft) -> None:
    names = set()
    for file, content in found.files.items():
        path = PurePosixPath(file)
        if str(path.parent) != "schemas/messages" or not path.name.endswith(ENDING):
            continue
        name = path.name.removesuffix(ENDING)
        names.add(name)
        if isinstance(content, Unreadable):
            reason = content.decode("utf-8", "replace")
            found.say("unreadable-file", file, f"this can't be read: {reason}", "put a readable file there")
            continue
        schema, diagnostics = build_message(file, content)
        found.loose += diagnostics
        if schema is not None:
            found.messages[name] = schema
    found.names["schemas/messages"] = frozenset(names)

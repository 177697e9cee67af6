"""Build all files of a project into a `ProjectDraft`."""

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain
from os.path import splitext
from typing import Any, TypeVar
from unicodedata import normalize

from lumen.feature import Feature, VerbRow, resolve, rows
from lumen.feature.checking import wrong_fields
from lumen.fuzzy.controllers_by_role import by_role
from lumen.language.added_verbs import UNUSABLE
from lumen.language.diagnostics import ERROR, WARNING, Code, Diagnostic, Severity, has_errors
from lumen.language.folders import FUNCTIONS_FOLDER, KNOWLEDGE_FOLDER, QUESTIONS_FOLDER, SAYINGS_FOLDER
from lumen.language.json_paths import values_in
from lumen.language.machines import MachineDefinition
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.language.shared import SharedKeys
from lumen.language.stories import Story
from lumen.language.verbs import is_built_in
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.behaviors import build_machine
from lumen.project.bodies import build_body, build_likes
from lumen.project.broken_features import BROKEN_FEATURE, faults_reported, shown
from lumen.project.built_file import Build, BuiltFile, read_file
from lumen.project.chosen_model import chosen
from lumen.project.chosen_robot import chosen_robot
from lumen.project.common_words import COMMON, COMMON_FILE, is_shipped, with_common_words
from lumen.project.controllers import build_controller
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.files import LEADS_OUT, MISTAKEN_FOLDERS, Unreadable
from lumen.project.functions import build_function, joined
from lumen.project.knowledge import MARKDOWN_SUFFIX, build_passage, build_questions
from lumen.project.lending import lend, shipped_models
from lumen.project.life import build_gestures, build_life
from lumen.project.linking import link, with_robots
from lumen.project.main_file import settings_builder
from lumen.project.messages import SCHEMA_SUFFIX, build_message
from lumen.project.motions import build_motions
from lumen.project.project_folders import (
    ALL_FOLDERS,
    GESTURES_FOLDER,
    LIFE_FOLDER,
    MAIN_FILE,
    MAIN_KIND,
    MESSAGES,
    MODELS,
    MOTIONS,
    PASSAGES,
    WORDS_FOLDER,
    endings_in,
    gestures_of,
    is_robots_own,
    kind_in,
    kind_of,
    life_of,
)
from lumen.project.sections import added_schema
from lumen.project.settings import Settings, other_vocabulary
from lumen.project.stories import build_sayings, build_story
from lumen.project.unread import robots_own_hint
from lumen.project.used_routes import used_routes
from lumen.project.words import build_words


def belongs_to(data: Any, body: Body) -> bool:
    """Return True if the body has both postures of a passage, and at least one of its joints if it names any."""
    if not isinstance(data, Mapping) or not {"start", "end"} <= data.keys():
        return True  # its faults are reported elsewhere
    if data["start"] not in body.postures or data["end"] not in body.postures:
        return False
    joints = _joints(data)
    first = next(joints, None)
    return first is None or any(joint in body.joints for joint in chain((first,), joints))


def _joints(data: Any) -> Iterator[str]:
    """Yield the name of every joint in the data of a motion file."""
    for item in values_in(data):
        if isinstance(item, Mapping) and isinstance(item.get("joints"), Mapping):
            yield from item["joints"]


MISSING_FILE = Code("missing-file", "text", ERROR, "a required file is missing")
NOT_READ = Code("not-read", "text", WARNING, "a file is not read, because of its ending or its folder")
UNREADABLE_FILE = Code("unreadable-file", "text", ERROR, "a file can't be opened")


T = TypeVar("T")


def draft(files: Mapping[str, bytes]) -> ProjectDraft:
    """Return a draft with everything that can be built from these files, and the findings.

    The result depends only on the files and on the installed software. No content of a file raises an error.
    """
    files = with_common_words(files)
    found = ProjectDraft(files)
    _folders(found)
    if (content := files.get(MAIN_FILE)) is None:
        found.say(
            MISSING_FILE,
            MAIN_FILE,
            "there is no lumen.yaml",
            "run `lumen new DIR` to make a project, or run this in a project's folder",
        )
    elif main := _main(found, content, chosen_robot(files)):
        if main.built and (other := other_vocabulary(main.built, main.report)):
            return ProjectDraft(files, loose=[other])
        found.settings = main.built and replace(main.built, model=chosen(files, main.built.model))
    _beside(found)
    functions = _each(found, FUNCTIONS_FOLDER, build_function)
    found.functions, found.known_functions = joined(functions, found.names[FUNCTIONS_FOLDER])
    models, behaviors = _each(found, MODELS, build_body), _behaviors(found)
    found.controllers = _built(_each(found, "fuzzy", build_controller))
    if found.settings:
        lost = found.reports[MAIN_FILE].lost
        used = used_routes(found.settings, _built(behaviors), found.controllers.values(), lost)
        found.settings = replace(found.settings, routes={**found.settings.routes, **used})
        found.lent = lend(files, found.settings, [*_wanted(found.settings, models)])
        models |= _each(found, MODELS, build_body, found.lent)
    sources = {name: (file.data, file.report) for name, file in models.items()}
    found.bodies = build_likes(_built(models), sources, found.names[MODELS])
    reports = {name: file.report for name, file in behaviors.items()}
    found.behaviors = link(_built(behaviors), reports, found.names["behaviors"])
    if found.settings and found.settings.told_apart:
        robots = tuple(found.settings.robots)
        found.behaviors = {name: with_robots(machine, robots) for name, machine in found.behaviors.items()}
    found.stories = _stories(found)
    found.sayings = _built(_each(found, SAYINGS_FOLDER, build_sayings))
    found.knowledge = _built(_each(found, KNOWLEDGE_FOLDER, build_passage))
    found.questions = _built(_each(found, QUESTIONS_FOLDER, build_questions))
    if body := found.body:
        found.controllers = {name: by_role(each, body) for name, each in found.controllers.items()}
    passages = _motions(found, PASSAGES)
    found.motions = _motions(found, MOTIONS)
    _accompany(found)
    found.bodies = {name: replace(body, passages=tuple(passages.values())) for name, body in found.bodies.items()}
    _messages(found)
    _judge(found)
    return found


def _judge(found: ProjectDraft) -> None:
    """Set for each file whether it was built whole: no part was left out, and the file has no error."""
    torn = {d.place.file for d in found.loose if d.severity is Severity.ERROR}
    for file, report in found.reports.items():
        report.whole = not (report.pruned or file in torn or has_errors(report.diagnostics))


def _beside(found: ProjectDraft) -> None:
    """Build the files in the project's root folder that features have rows for."""
    for feature, (name, row) in rows("files"):
        if (content := found.files.get(name)) is not None:
            with faults_reported(feature, f"reading `{name}`", found.loose.append):
                if row.schema:
                    added_schema(row.schema)
                file = _read(found, name, content, kind_of(name), resolve(row.build))
                if file and file.built is not None:
                    found.beside[name] = file.built


def motion_parts(files: Mapping[str, bytes]) -> ProjectDraft:
    """Return the part of a project that a motion needs: its robot and the other motions. Other files are not read."""
    wanted = ("models/", "motions/")
    return draft({file: content for file, content in files.items() if file.startswith(wanted) or file == MAIN_FILE})


def knowledge_parts(files: Mapping[str, bytes]) -> ProjectDraft:
    """Return the passages of a project. Other files are not read."""
    return draft({file: content for file, content in files.items() if file.startswith(f"{KNOWLEDGE_FOLDER}/")})


def sayings_parts(files: Mapping[str, bytes]) -> ProjectDraft:
    """Return the sayings of a project. Other files are not read."""
    return draft({file: content for file, content in files.items() if file.startswith(f"{SAYINGS_FOLDER}/")})


def _main(found: ProjectDraft, content: bytes, robot: str) -> BuiltFile[Settings] | None:
    """Return the content of lumen.yaml for that robot; None if the file can't be read."""
    return _read(found, MAIN_FILE, content, MAIN_KIND, settings_builder(robot), robot)


def _wanted(settings: Settings, models: Mapping[str, BuiltFile[Body]]) -> Iterator[str]:
    """Yield the name of the robot's model, and the names of models on which the project's own models are based."""
    yield settings.model
    for file in models.values():
        if isinstance(file.data, Mapping):
            yield from (name for key in ("like", "mjcf") if isinstance(name := file.data.get(key), str))


def _behaviors(found: ProjectDraft) -> dict[str, BuiltFile[MachineDefinition]]:
    """Return the behaviours, each with the words files that it names. Also build the verbs and words of the draft."""
    found.verbs = _verbs(found)
    words = _each(found, WORDS_FOLDER, build_words)
    found.words = _built(words)
    known = found.names[WORDS_FOLDER]
    contents = {name: found.files[f"{WORDS_FOLDER}/{name}.yaml"] for name in known}
    settings = found.settings
    shared = settings.section(SharedKeys).by_name if settings else {}
    performed = {robot.behavior for robot in settings.robots.values()} if settings and shared else set()
    languages, shipped = settings.languages if settings else (), is_shipped(found.files, COMMON)
    build = partial(
        build_machine,
        words=words,
        known=known,
        shared=shared,
        performed=performed,
        languages=languages,
        shipped=shipped,
        verbs=found.verbs,
        functions=found.known_functions,
    )
    around = (contents, shared, performed, languages, shipped, found.known_functions)
    behaviors = _each(found, "behaviors", build, around=around, verbs=found.verbs)
    if shipped:
        found.reports.pop(COMMON_FILE, None)
    return behaviors


def _verbs(found: ProjectDraft) -> OwnVerbs:
    """Return the verbs that files of the project declare, in the folders that features read."""
    languages = found.settings.languages if found.settings else ()
    verbs: dict[str, VerbRow] = {}
    contents = hashlib.sha256(repr(languages).encode())
    for feature, (folder, where) in rows("verb_files"):
        if not any(file.startswith(f"{folder}/") for file in found.files):
            continue  # most projects have none, and then the reader need not be imported
        build = partial(_verb, feature, where, languages=languages)
        files = _each(found, folder, build, around=languages)
        found.loose += (d for each in files.values() for d in each.report.diagnostics if d.code == BROKEN_FEATURE)
        built = _built(files)
        verbs |= {name: built.get(name, UNUSABLE) for name in sorted(found.names[folder]) if not is_built_in(name)}
        for name in sorted(found.names[folder]):
            contents.update(name.encode() + found.files[f"{folder}/{name}.yaml"])
    return OwnVerbs(verbs, contents.hexdigest()) if verbs else NO_VERBS


def _verb(
    feature: Feature, where: str, data: Any, report: DocumentReport, *, name: str, languages: Sequence[str]
) -> VerbRow | None:
    """Return the verb that a file declares, None if it declares none; report a fault of a package's code."""

    def report_here(fault: Diagnostic) -> None:
        report.diagnostics.append(replace(fault, place=report.document.place(())))

    with faults_reported(feature, f"reading the verb `{name}`", report_here):
        made = resolve(where)(data, report, name=name, languages=languages)
        if made is None or (isinstance(made, VerbRow) and not [*wrong_fields(made)]):
            return made
        raise TypeError(f"`{where}` returned {shown(made)}, which is no valid `VerbRow`")
    return None


def _stories(found: ProjectDraft) -> dict[str, Story]:
    build = partial(build_story, verbs=found.verbs, functions=found.known_functions)
    around = (found.verbs, found.known_functions)
    return _built(_each(found, "behaviors/stories", build, around=around, verbs=found.verbs))


def _each(
    found: ProjectDraft,
    folder: str,
    build: Build[T],
    files: Mapping[str, bytes] | None = None,
    *,
    around: object = None,
    verbs: OwnVerbs = NO_VERBS,
) -> dict[str, BuiltFile[T]]:
    """Return the documents of a folder by name: the project's own files, unless other `files` are given.

    `around` is any further input of `build`; `verbs` are the project's verbs that the documents can contain.
    """
    names, read = set(), dict[str, BuiltFile[T]]()
    files = found.files if files is None else files
    for file, content in files.items():
        above, _, name = file.rpartition("/")
        stem, suffix = splitext(name) if above == folder else ("", "")
        if suffix not in (".yaml", ".yml", MARKDOWN_SUFFIX):
            continue
        if suffix == ".yml":
            hint = f"rename it to {stem}.yaml, or delete it"
            found.say(NOT_READ, file, "Lumen does not read files that end in .yml", hint)
            continue
        composed = normalize("NFC", stem)
        if stem in names or (stem != composed and f"{folder}/{composed}{suffix}" in files):
            message = f"Lumen does not read this file: {folder}/ has another file called {composed}"
            found.say(NOT_READ, file, message, "combine them, or rename one of them")
            continue
        names.add(stem)
        if (each := _read(found, file, content, kind_in(folder), build, around, verbs)) is not None:
            read[stem] = each
    found.names[folder] = found.names.get(folder, frozenset()) | names
    return read


def _built(files: Mapping[str, BuiltFile[T]]) -> dict[str, T]:
    """Return the built values by name, leaving out files with too little content to build a value."""
    return {name: file.built for name, file in files.items() if file.built is not None}


def _folders(found: ProjectDraft) -> None:
    """Report folders that can't be read, which are added to `missing`, and folders with a mistaken name."""
    for name, content in found.files.items():
        if isinstance(content, Unreadable) and (name in ALL_FOLDERS or name in MISTAKEN_FOLDERS or endings_in(name)):
            hint = "replace it with a folder inside the project: Lumen reads nothing outside the project"
            if content != LEADS_OUT:
                hint = "make it a readable folder, or delete it"
            found.say(UNREADABLE_FILE, name, f"this can't be read: {content.decode()}", hint)
            found.missing |= {folder for folder in ALL_FOLDERS if folder == name or folder.startswith(f"{name}/")}
    for folder, meant in MISTAKEN_FOLDERS.items():
        inside = [name for name in found.files if name.startswith(f"{folder}/")]
        linked = {name for name in inside if found.files.get(meant + name[len(folder) :]) == found.files[name]}
        if astray := next((name for name in inside if name not in linked), ""):
            hint = f"move the files that belong to the exhibition to {meant}/"
            found.say(NOT_READ, astray, f"files in {folder}/ are not read", hint)


def _read(
    found: ProjectDraft,
    file: str,
    content: bytes,
    kind: str,
    build: Build[T],
    around: object = None,
    verbs: OwnVerbs = NO_VERBS,
) -> BuiltFile[T] | None:
    """Return the content of one document, and keep its findings; None if the document can't be read at all."""
    if isinstance(content, Unreadable):
        hint = "make it a readable file, or delete it"
        found.say(UNREADABLE_FILE, file, f"this can't be read: {content.decode('utf-8', 'replace')}", hint)
        return None
    read, diagnostics = read_file(file, content, kind, build, around, verbs)
    found.loose += diagnostics
    if read is not None:
        found.reports[file] = read.report
    return read


def _motions(found: ProjectDraft, folder: str) -> dict[str, MotionDefinition]:
    """Return the motions of a folder; none if the robot's body is not known."""
    files_there = {**found.files, **found.lent}
    read = partial(_each, found, build=lambda data, report, name: None, files=files_there, verbs=found.verbs)
    files: dict[str, BuiltFile[None]] = read(folder)
    only = next(iter(found.bodies)) if found.settings is None and len(found.bodies) == 1 else ""
    model = found.settings.model if found.settings else only
    if folder == MOTIONS:
        _strangers(found)
        own: dict[str, BuiltFile[None]] = read(f"{MOTIONS}/{model}") if model else {}
        files |= own
        found.own_motions = frozenset(own)
        found.names[MOTIONS] = found.names[MOTIONS] | own.keys()
    if model not in found.bodies:
        return {}
    body = found.bodies[model]
    if folder == PASSAGES:
        files = {name: file for name, file in files.items() if belongs_to(file.data, body)}
    for file in files.values():
        file.report.lost |= found.report(MODELS, model).lost
    return build_motions({name: (file.data, file.report) for name, file in files.items()}, body, found.verbs)


def _strangers(found: ProjectDraft) -> None:
    """Report subfolders of motions/ that are named after no robot model: their motions are never played."""
    known = {*found.names[MODELS], *shipped_models()}
    inside = (file.split("/") for file in found.files if file.startswith(f"{MOTIONS}/"))
    for name in {parts[1] for parts in inside if len(parts) > 2}:
        folder = f"{MOTIONS}/{name}"
        if is_robots_own(folder) and name not in known:
            hint = robots_own_hint(name, known)
            first = min(file for file in found.files if file.startswith(f"{folder}/"))
            found.say(NOT_READ, first, f"files in {folder}/ are not read: no model is called `{name}`", hint)


def _accompany(found: ProjectDraft) -> None:
    """Build the styles of life and the gestures of speech; without a body, only check the shape of the files."""
    if body := found.body:
        model = found.settings.model if found.settings else ""
        life, gestures = partial(build_life, body=body), partial(build_gestures, body=body)
        found.life, found.own_life = _with_own(found, life_of(model), LIFE_FOLDER, life, body)
        found.gestures, found.own_gestures = _with_own(found, gestures_of(model), GESTURES_FOLDER, gestures, body)
    else:
        for folder in (LIFE_FOLDER, GESTURES_FOLDER):
            _each(found, folder, lambda data, report, name: None)


def _with_own(
    found: ProjectDraft, folder: str, shared: str, build: Build[T], body: Body
) -> tuple[dict[str, T], frozenset[str]]:
    """Return all styles or gestures by name; those in the robot's own folder replace those for all robots.

    The second value is the set of names in the robot's own folder.
    """
    own = _built(_each(found, folder, build, around=body))
    replaced = {file: found.files[file] for name in own if (file := f"{shared}/{name}.yaml") in found.files}
    left = {file: content for file, content in found.files.items() if file not in replaced}
    _each(found, shared, lambda data, report, name: None, replaced)
    others = _built(_each(found, shared, build, left, around=body))
    found.names[shared] = found.names[shared] | own.keys()
    return {**others, **own}, frozenset(own)


def _messages(found: ProjectDraft) -> None:
    names = set()
    for file, content in {**found.files, **found.lent}.items():
        folder, _, name = file.rpartition("/")
        if folder != MESSAGES or not name.endswith(SCHEMA_SUFFIX):
            continue
        name = name.removesuffix(SCHEMA_SUFFIX)
        names.add(name)
        if isinstance(content, Unreadable):
            reason = content.decode("utf-8", "replace")
            found.say(UNREADABLE_FILE, file, f"this can't be read: {reason}", "make it a readable file")
            continue
        schema, diagnostics = build_message(file, content)
        found.loose += diagnostics
        if schema is not None:
            found.messages[name] = schema
    found.names[MESSAGES] = frozenset(names)

"""Check documents against the JSON Schema of their kind: report each error at its node, and prune broken nodes."""

import json
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache, partial
from typing import Any

from lumen.errors import LumenError
from lumen.expressions.json_schema import JsonSchema
from lumen.feature import VerbRow, owner, table
from lumen.language.added_verbs import UNUSABLE, expected_schema, written_schema
from lumen.language.diagnostics import NodePath
from lumen.language.text_lines import lines_of
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.broken_features import blaming
from lumen.project.complaints import MISSING_KEY, ONE_VERB, UNKNOWN_KEY, WRONG_KEY, WRONG_TYPE, Complaint, complaints
from lumen.project.document import TOO_LARGE, Document
from lumen.project.document_report import DocumentReport, prune
from lumen.project.feature_schemas import add_bases, add_features
from lumen.project.misindented import KeyNames, key_names, misindented
from lumen.project.misplaced import misplaced
from lumen.project.packaged import schema_folder
from lumen.project.project_folders import KINDS, MAIN_KIND
from lumen.project.sections import added_schema, with_sections
from lumen.project.torn_texts import quoting, whole_translation
from lumen.project.yaml_nodes import read_text

MAX_PRUNING_ROUNDS = 20
MAX_SCHEMAS = 64
"""The maximum number of cached schemas: one for each kind of file and version of a project's own verbs."""

_ASTRAY = (UNKNOWN_KEY, ONE_VERB)
"""The codes of complaints about keys that belong below the key above them."""


def check_schema(document: Document, kind: str, report: DocumentReport, verbs: OwnVerbs = NO_VERBS) -> Any:
    """Return the document's data without what its schema refuses; each error is reported at its node.

    A broken node is removed with its key, or as an item of its list. One that lacks a required key is removed as a
    whole, except the root, whose required keys the builder checks itself. The result is None if nothing is
    left, or if the file is of another kind or nested too deeply, which is reported. The report's document becomes the
    pruned one, so that paths into the returned data have the right places; the names that were removed are in its
    `lost`. `verbs` are those that the project declares.
    """
    said: set[NodePath] = set()
    moved: Mapping[Complaint, str] = {}
    for turn in range(MAX_PRUNING_ROUNDS):
        try:
            if _schema(kind, verbs).fits(report.document.data):
                return report.document.data
            if misplaced(report.document.data, kind, report):
                return None
            found = list(_complaints(_schema(kind, verbs), report.document.data))
            if not turn:
                moved = misindented(report.document, found, _key_names(kind, verbs), partial(_judged, kind, verbs))
        except RecursionError:
            report(TOO_LARGE, (), "the file is nested too deeply to be read", hint="use fewer levels")
            return None
        doomed = _judge(found, report, said, moved, _key_names(kind, verbs))
        if () in doomed:
            return None
        if not doomed:
            return report.document.data
        prune(report, doomed)
        report.pruned |= {(*c.about, c.suggestion) for c in found if c.suggestion}
    return None


def misfits(kind: str, text: str) -> int | None:
    """Return the number of faults that a kind's schema finds in a text; None if the text is no YAML or too deep."""
    try:
        found = _judged(kind, NO_VERBS, text)
    except RecursionError:
        return None
    return None if found is None else len(found)


def load_schema(kind: str, verbs: OwnVerbs = NO_VERBS) -> Any:
    """Return the JSON Schema of a kind of file as data, with the additions of features and of the project's `verbs`.

    Raises LumenError if the schema's file is damaged or missing, or if the feature of the file has no usable schema.
    """
    file_name = f"{kind}.yaml"
    if (row := table("files").get(file_name)) and row.schema and kind not in KINDS.values():
        with blaming(owner("files", file_name), row.schema):
            return added_schema(row.schema)
    file = schema_folder() / f"{kind}.schema.json"
    try:
        schema = json.loads(file.read_bytes())
    except (OSError, ValueError) as error:
        raise LumenError(f"Lumen's own {file} can't be read ({error}): reinstall Lumen, or restore the file") from None
    if kind == MAIN_KIND:
        add_features(schema)
        return with_sections(schema)
    if kind == "body":
        add_bases(schema)
    if added := verbs.all:
        _add_verbs(schema, kind, added)
    return schema


def _add_verbs(schema: Any, kind: str, verbs: Mapping[str, VerbRow]) -> None:
    """Add verbs to the schema of behaviours, motions or stories."""
    if kind == "motion":
        keys = schema["$defs"]["keyframe"]["properties"]
        keys |= {name: written_schema(row) for name, row in verbs.items() if name not in keys}
    elif kind == "behavior":
        schema["$defs"]["action"]["properties"] |= {name: written_schema(row) for name, row in verbs.items()}
    elif kind == "story":
        robot = schema["properties"]["robot"]
        robot["propertyNames"]["enum"] += verbs
        robot["properties"] = {name: _performance(row) for name, row in verbs.items()}
        steps = schema["$defs"]["step"]["properties"]
        steps["expect"]["properties"]["did"] = _did(verbs)
        ends = {name: _end(schema, row) for name, row in verbs.items()}
        steps["skills"] = {**steps["skills"], "additionalProperties": False, "properties": ends}


def _performance(row: VerbRow) -> dict[str, Any]:
    """Return the schema for how the recording robot performs an added verb in a story."""
    result = {"description": "What it returns.", **row.result, "type": "object"}
    return {
        "description": "`fails`, `hangs`, a duration, or how long it takes and what it returns",
        "type": ["string", "object"],
        "minProperties": 1,
        "additionalProperties": False,
        "properties": {"takes": {"$ref": "#/$defs/duration"}, "result": result},
    }


def _end(schema: Any, row: VerbRow) -> dict[str, Any]:
    """Return the schema for how an added verb ends in a story."""
    if row == UNUSABLE:
        return {}
    result = {"additionalProperties": False, **row.result, "type": "object"}
    return {**schema["$defs"]["end"], "description": row.description or "A result, `fails` or `hangs`.", "else": result}


def _did(verbs: Mapping[str, VerbRow]) -> dict[str, Any]:
    """Return the schema for an added verb in an expectation."""
    return {
        "description": "A skill or a package's verb that it finished since then; maybe with some of its arguments.",
        "type": ["string", "object"],
        "if": {"type": "string"},
        "then": {"enum": list(verbs)},
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": False,
        "properties": {name: expected_schema(row) for name, row in verbs.items()},
    }


def faults(data: Any, schema: Mapping[str, Any]) -> list[Complaint]:
    """Return the faults that a JSON Schema, which must be valid itself, finds in data."""
    return _faults(JsonSchema(schema), data)


def schema_faults(schema: Any) -> list[Complaint]:
    """Return the faults of a JSON Schema itself, except those that its metaschema can't find."""
    return _faults(_schema("message", NO_VERBS), schema)


def _faults(schema: JsonSchema, data: Any) -> list[Complaint]:
    try:
        return [] if schema.fits(data) else list(_complaints(schema, data))
    except RecursionError:
        return [Complaint(TOO_LARGE, (), "this is nested too deeply to be read", "use fewer levels", (), ())]


@lru_cache(maxsize=MAX_SCHEMAS)
def _schema(kind: str, verbs: OwnVerbs) -> JsonSchema:
    return JsonSchema(load_schema(kind, verbs))


def _complaints(schema: JsonSchema, data: Any) -> Iterator[Complaint]:
    for error in schema.errors(data):
        yield from complaints(error, schema.schema)


@lru_cache(maxsize=MAX_SCHEMAS)
def _key_names(kind: str, verbs: OwnVerbs) -> KeyNames:
    return key_names(_schema(kind, verbs).schema)


def _judged(kind: str, verbs: OwnVerbs, text: str) -> list[Complaint] | None:
    """Return the faults that the schema of that kind finds in a text; None if it is not YAML."""
    document = read_text(text)
    if not document:
        return None
    schema = _schema(kind, verbs)
    return [] if schema.fits(document.data) else list(_complaints(schema, document.data))


def _judge(
    found: list[Complaint], report: DocumentReport, said: set[NodePath], moved: Mapping[Complaint, str], names: KeyNames
) -> set[NodePath]:
    """Return the paths to prune, and report the findings, except those that follow from others or are known already."""
    suggested = {(c.path[:-1], c.suggestion) for c in found if c.suggestion}
    doomed = {c.doomed for c in found if c.doomed is not None}
    emptied, outdented = _emptied(found, report), _outdented(found, report)
    spoken: set[NodePath] = set()
    for complaint in found:
        about = complaint.about
        if complaint in moved:
            if hint := moved[complaint]:
                beside = (*about[:-1], complaint.missing)
                path, key = (beside, True) if beside in report.document.spans else (complaint.path, complaint.key)
                report(complaint.code, path, complaint.message, hint=hint, key=key)
                report.lost |= {str(key) for key in about[-1:] if key in names.declared}  # it is no event or state
            spoken.add(complaint.path)
            continue
        if complaint.missing and (beside := (*about[:-1], complaint.missing)) in outdented:
            message = f"{complaint.message}, which is beside it"
            report(complaint.code, beside, message, hint=f"indent `{complaint.missing}` further", key=True)
            continue
        if any(path[: len(beside)] == beside for beside in outdented for path in (about, complaint.path)):
            continue
        if about in emptied and complaint.code in _ASTRAY:
            continue  # it should have been indented further
        follows = any(path[: len(about)] == about for path in report.pruned) if about else False
        lost = bool(complaint.missing) and (*about, complaint.missing) in report.pruned
        meant = bool(complaint.missing) and (about, complaint.missing) in suggested
        tagged = complaint.code == WRONG_TYPE and _begins(report, complaint.path, "!")  # its tag was reported
        if not (follows or lost or meant or tagged or complaint.path in spoken or complaint.path in said):
            hint = complaint.hint
            if complaint.path in emptied.values():
                hint = "indent the lines that belong under it further than its key"
            elif complaint.code == WRONG_TYPE and (comment := _comment(report, complaint.path)):
                hint = f'`#` begins a comment: put quotes around it: "{comment}"'
            torn = complaint.code in (WRONG_KEY, WRONG_TYPE) and whole_translation(report.document, complaint.path)
            cause, hint = _cause(complaint, report), quoting(torn) if torn else hint
            report(
                complaint.code, complaint.path, complaint.message, hint, key=complaint.key or bool(torn), cause=cause
            )
        spoken.add(complaint.path)
        if complaint.doomed is None:
            said.add(complaint.path)
    return doomed


def _emptied(found: list[Complaint], report: DocumentReport) -> dict[NodePath, NodePath]:
    """Return the misplaced nodes that probably belong under an empty key before them, each with that key's path."""
    empty = {
        c.about[:-1]: c.path for c in found if c.code == WRONG_TYPE and c.path and report.document.value(c.path) is None
    }
    found_below: dict[NodePath, NodePath] = {}
    for complaint in found:
        if complaint.code in _ASTRAY and complaint.about:
            parent = complaint.about if complaint.about in empty else complaint.about[:-1]
            if parent in empty and _stands_after(report, complaint.path, empty[parent]):
                found_below[complaint.about] = empty[parent]
    return found_below


def _outdented(found: list[Complaint], report: DocumentReport) -> set[NodePath]:
    """Return the nodes that are invalid in their place and missing in the node before them."""
    wrong = {path[:n] for c in found if not c.missing for path in (c.about, c.path) for n in range(1, len(path) + 1)}
    missed = ((c, (*c.about[:-1], c.missing)) for c in found if c.missing and c.about)
    return {beside for c, beside in missed if beside in wrong and _stands_after(report, beside, c.about)}


def _stands_after(report: DocumentReport, path: NodePath, other: NodePath) -> bool:
    spans = report.document.spans
    return path in spans and other in spans and spans[path].value > spans[other].value


def _cause(complaint: Complaint, report: DocumentReport) -> str:
    """Return the cause that several unknown or missing keys of one node share, since they are usually one mistake."""
    if complaint.suggestion or complaint.code not in (UNKNOWN_KEY, MISSING_KEY):
        return ""
    if not complaint.about and complaint.hint:  # each unknown key of the root may be a mistake of its own
        return ""
    return f"{report.document.file} keys of {complaint.about}"


def _begins(report: DocumentReport, path: NodePath, sign: str) -> bool:
    """Return True if the node at a path is written with this character at its beginning."""
    if path not in report.document.spans:
        return False
    place = report.document.place(path)
    return lines_of(report.document.text)[place.line - 1][place.column - 1 :].startswith(sign)


def _comment(report: DocumentReport, path: NodePath) -> str:
    """Return the comment in place of a value, if it may have been meant as the value: `onDone: #offer`."""
    place = report.document.place(path, key=True)
    line = lines_of(report.document.text)[place.line - 1] if path in report.document.spans else ""
    found = re.match(r": +(#[\w.-]+)\s*$", line[place.end_column - 1 :])
    return found[1] if found and report.document.value(path) is None else ""

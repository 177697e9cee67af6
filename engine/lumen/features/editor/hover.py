"""Descriptions of the name at the cursor, in Markdown."""

from collections.abc import Sequence
from math import degrees
from pathlib import PurePosixPath

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.heard_rows import is_phrase
from lumen.features.editor.index import WORDS_SCOPE
from lumen.features.editor.locating import key_at
from lumen.features.editor.names import NameKind, NameUse, covers
from lumen.features.editor.schemas import description_at
from lumen.features.editor.sentences import of_patterns, of_phrase_at, of_row_at
from lumen.language.counts import counted
from lumen.language.diagnostics import Diagnostic
from lumen.lint.codes import codes
from lumen.lint.pages import page
from lumen.project.common_words import COMMON, COMMON_FILE
from lumen.project.draft import ProjectDraft
from lumen.project.project_folders import WORDS_FOLDER, kind_of

MAX_PHRASES = 20
"""The maximum number of phrases that are shown per language."""


def hover(analysis: Analysis, file: str, line: int, column: int) -> str:
    """Return the text about the name or key at a line and column, from 1, and its findings; empty if there is none."""
    parts = [of_row_at(analysis, file, line, column)]
    use = analysis.index.at(file, line, column)
    if use:
        parts.append(describe(analysis, use))
    elif said := _described(analysis, file, line, column):
        parts.append(said)
    parts += [explain(d) for d in analysis.diagnostics if d.place.file == file and covers(d.place, line, column)]
    return "\n\n---\n\n".join(filter(None, parts))


def describe(analysis: Analysis, use: NameUse) -> str:
    """Return the Markdown that describes a name, such as a state's path, a motion's duration or a joint's limits."""
    title = f"{use.kind} `{use.name}`"
    facts = _facts(analysis, use)
    if use.scope == WORDS_SCOPE + COMMON and COMMON_FILE not in analysis.files:
        facts += f"\n\nIt comes with Lumen. To replace it, define it in a file in {WORDS_FOLDER}/."
    uses = sum(1 for other in analysis.index.of(use) if not other.defines and other.text)
    return "\n\n".join(filter(None, [f"**{title}**", facts, f"used {uses} times" if uses > 1 else ""]))


def explain(diagnostic: Diagnostic) -> str:
    """Return a finding's meaning and importance from its rule's page, else the rule's summary; empty without a rule."""
    code = codes().get(diagnostic.code)
    if code is None:
        return ""
    try:
        rule = page(diagnostic.code)
    except OSError:
        return f"**{diagnostic.code}**: {code.summary}"
    return f"**{diagnostic.code}**: {rule.what}\n\n{rule.why}"


def _facts(analysis: Analysis, use: NameUse) -> str:
    draft = analysis.draft
    match use.kind:
        case NameKind.STATE:
            return _state(draft, use)
        case NameKind.MOTION:
            motion = draft.motions.get(use.name)
            moves = f"{motion.duration:g} s, moves {counted(len(motion.tracks), 'joint')}" if motion else ""
            return f"{moves}{f', begins in {motion.start}' if motion and motion.start else ''}"
        case NameKind.SKILL:
            return _skill(draft, use.name)
        case NameKind.JOINT:
            return _joint(draft, use.name)
        case NameKind.CONTEXT:
            machine = draft.behaviors.get(use.scope)
            known = machine is not None and use.name in machine.context
            return f"begins with `{machine.context[use.name]!r}`" if machine and known else ""
        case NameKind.ROUTE:
            route = draft.settings.routes.get(use.name) if draft.settings else None
            event = f", becomes the event `{route.event}`" if route and route.event else ""
            origin = ", comes with Lumen" if route and route.built_in else ""
            return f"`{route.key}` ({route.direction}){event}{origin}" if route else ""
        case NameKind.PHRASE:
            holder = draft.words.get(use.scope.removeprefix(WORDS_SCOPE)) or draft.behaviors.get(use.scope)
            rows = holder.phrases.get(use.name, {}) if holder else {}
            said = [f"- {language or 'any'}: {_some(texts)}" for language, texts in rows.items()]
            return "\n".join([*said, *of_patterns(draft, [text for texts in rows.values() for text in texts])])
        case NameKind.FUNCTION:
            return _function(draft, use.name)
        case NameKind.EVENT:
            routes = draft.settings.routes.values() if draft.settings else ()
            return "\n".join(f"from the route `{r.name}` (`{r.key}`)" for r in routes if r.event == use.name)
        case NameKind.MESSAGE:
            schema = draft.messages.get(use.name, {})
            return str(schema.get("description", schema.get("title", "")))
    return ""


def _skill(draft: ProjectDraft, name: str) -> str:
    """Return a skill's description, arguments and time; empty if the skill is unknown."""
    if (row := draft.verbs.rows.get(name)) is None:
        return ""
    arguments = ", ".join(f"`{each}`" for each in row.arguments.get("properties", ()))
    facts = [f"arguments: {arguments}" if arguments else "", f"takes `{row.takes}`" if row.takes != "0s" else ""]
    return "\n\n".join(filter(None, [row.description, "; ".join(filter(None, facts))]))


def _some(texts: Sequence[str]) -> str:
    """Return the first `MAX_PHRASES` texts, and the number of those left out, if any."""
    more = len(texts) - MAX_PHRASES
    return ", ".join(texts[:MAX_PHRASES]) + (f" and {more} more" if more > 0 else "")


def _state(draft: ProjectDraft, use: NameUse) -> str:
    machine = draft.behaviors.get(use.scope)
    state = machine.states.get(use.name) if machine else None
    if state is None:
        return ""
    inner = f", with {counted(len(state.children), 'state')}" if state.children else ""
    alias = f", id `{state.alias}`" if state.alias and state.alias != state.path else ""
    return f"{state.kind} state at `{state.path}`{alias}{inner}"


def _joint(draft: ProjectDraft, name: str) -> str:
    if draft.body is None or (joint := draft.body.joints.get(name)) is None:
        return ""
    if name in draft.body.hands:
        return "a hand: 0 is closed, 1 open"
    if name in draft.body.slides:
        low, high, most = (1000 * length for length in (joint.minimum, joint.maximum, joint.speed))
        return f"slides from {low:.1f} to {high:.1f} mm" + (f", at most {most:.0f} mm/s" if most < 1e6 else "")
    low, high = degrees(joint.minimum), degrees(joint.maximum)
    speed = f", at most {degrees(joint.speed):.0f} deg/s" if joint.speed < 1e3 else ""
    return f"{low:.1f} to {high:.1f} deg ({joint.minimum:.3f} to {joint.maximum:.3f} rad){speed}"


def _function(draft: ProjectDraft, name: str) -> str:
    if (function := draft.functions.get(name)) is None:
        return ""
    languages = draft.settings.languages if draft.settings else ()
    arguments = ", ".join(f"{each}: {' or '.join(kinds)}" for each, kinds in function.parameters.items())
    shown = f"```\n{name}({arguments})\n    {function.expression}\n```"
    return "\n\n".join(filter(None, [function.described(languages[0] if languages else ""), shown]))


def _described(analysis: Analysis, file: str, line: int, column: int) -> str:
    """Return the schema's description of the key there, or sample sentences for the phrase; empty if there is none."""
    document = analysis.documents.get(file)
    if document is None or PurePosixPath(file).suffix != ".yaml":
        return ""
    kind = kind_of(file)
    if found := key_at(document, line, column):
        text = description_at(kind, found, analysis.draft.verbs)
        return f"`{found[-1]}`: {text}" if text else ""
    phrases = (p for p, span in document.spans.items() if is_phrase(kind, p) and covers(span.value, line, column))
    return next(filter(None, (of_phrase_at(analysis, file, path) for path in phrases)), "")

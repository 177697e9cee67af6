"""Reads XState's actions, guards and delays: built-in ones, those that Lumen wrote, and names without code."""

import json
import re
from collections.abc import Mapping
from typing import Any

from lumen.expressions.kinds import kind_of
from lumen.features.formats_charts.xstate.json_source import JsonSource
from lumen.features.formats_charts.xstate.known import losses
from lumen.features.formats_charts.xstate.names import XStateNames
from lumen.language.actions import PARENT
from lumen.language.diagnostics import NodePath, has_errors
from lumen.language.numbers import is_number
from lumen.project.behaviors import build_machine
from lumen.project.document_report import DocumentReport
from lumen.project.formats.behavior_data import ActionData, TransitionData, quoted
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.durations import MAX_DELAY, duration
from lumen.project.plain import plain_document
from lumen.project.schema import check_schema

EXPRESSION_GUARD = "lumen.expression"
HEARS_GUARD = "lumen.hears"
DO_ACTOR = "lumen.do"
ACTION_PREFIX = "lumen."
_BUILT_IN = ("xstate.raise", "xstate.send", "xstate.sendTo", "xstate.cancel", "xstate.log", "xstate.assign")
_UNFIT = re.compile(r"\W+", re.ASCII)


class XStateActionReader:
    """Reads the actions, guards and delays of one file; each guard without code adds a key to `context`."""

    def __init__(
        self, source: JsonSource, context: dict[str, Any], names: XStateNames, findings: ConversionFindings
    ) -> None:
        self.source, self.context, self.names, self.findings = source, context, names, findings
        self.wide: dict[str, dict[str, Any]] = {}
        """The entries of `types` for context keys that receive values of several kinds."""
        self.surroundings: dict[str, Any] = {}
        self.row = ""
        """The key of the `hears` row whose actions are being read; empty for other transitions."""
        self._guards: dict[str, str] = {}

    def lost(self, where: NodePath, message: str, hint: str = "") -> None:
        """Report that the data at a path could not be converted."""
        self.findings.lost(self.source.place(where), message, hint)

    def changed(self, where: NodePath, message: str, hint: str = "") -> None:
        """Report that the data at a path was converted with a difference."""
        self.findings.changed(self.source.place(where), message, hint)

    def actions(self, data: Any, where: NodePath) -> list[ActionData]:
        """Convert a name, an object or a list of these to actions; report those without code, which become `log`."""
        if data is None:
            return []
        rows = [((*where, i), row) for i, row in enumerate(data)] if isinstance(data, list) else [(where, data)]
        return [action for place, row in rows if (action := self._action(row, place))]

    def _action(self, data: Any, where: NodePath) -> ActionData | None:
        kind = data.get("type") if isinstance(data, dict) else data
        if data is None:
            self.lost(where, "an action is null: JSON can't contain its code", "give the action a name in `setup`")
            return None
        if not isinstance(kind, str):
            self.lost(where, "this is not an action", 'write "name" or {"type": "name", "params": …}')
            return None
        params = data.get("params") if isinstance(data, dict) else None
        if kind.startswith(ACTION_PREFIX) and (own := self._own(kind.removeprefix(ACTION_PREFIX), params)):
            self._unread("action", data, where)
            return own
        if kind in _BUILT_IN and isinstance(data, dict):
            body = {**(params if isinstance(params, dict) else {}), **data}  # tools write either form
            place = "xstate.send" if kind == "xstate.sendTo" else kind
            self._unread(place, data, where)
            self._params(place, data, where)
            try:
                return self._built_in(kind, body, where)
            except _AbsentError as error:
                self.lost(where, f"`{kind}`: {error}", "a `log` replaces it: write the action into the behaviour")
        else:
            self.lost(
                where,
                f"the code of the action `{kind}` is not in the file",
                "a `log` replaces it: write the action into the behaviour",
            )
        return _logged(shown_name(kind, data))

    def _params(self, place: str, data: Mapping[str, Any], where: NodePath) -> None:
        """Report the entries of `params`, an alternative form of built-in actions, that are not converted."""
        params, where = data.get("params"), (*where, "params")
        if params is not None and not isinstance(params, dict):
            self.lost(where, f"`params` of an {place} is not an object", "delete it")
            return
        self._unread(place, params, where)
        for key in params or ():
            if key in ("type", "params") or key in data:
                self.lost((*where, key), f"`{key}` in `params` of an {place} is left out", "delete it")

    def _unread(self, place: str, data: Any, where: NodePath) -> None:
        for key, message, hint in losses(place, data if isinstance(data, dict) else ()):
            self.lost((*where, key), message, hint)

    def _own(self, verb: str, params: Any) -> ActionData | None:
        """Return an action that Lumen wrote, or None if it is no longer valid."""
        if verb == "if" and isinstance(params, dict):
            action = params
        else:
            action = {verb: params["value"] if isinstance(params, dict) and set(params) == {"value"} else params}
        around = {"hears": {self.row: {"actions": [action]}}} if self.row else {"entry": [action]}
        return action if self.fits(around) else None

    def _built_in(self, kind: str, data: Mapping[str, Any], where: NodePath) -> ActionData:
        """Convert one of XState's built-in actions. Raises _AbsentError if the JSON does not contain all of it."""
        match kind:
            case "xstate.raise":
                body = self._sent(data)
                if "delay" in body:
                    return {"send": body}
                body.pop("id", None)
                return {"raise": body if len(body) > 1 else body["event"]}
            case "xstate.send" | "xstate.sendTo":
                body = self._sent(data)
                if to := self._recipient(kind, data):
                    body["to"] = to
                return {"send": body if len(body) > 1 else body["event"]}
            case "xstate.cancel":
                return {"cancel": _text(data, "sendId")}
            case "xstate.log":
                parts = [data[key] for key in ("label", "expr") if data.get(key) not in (None, "")]
                if not parts or not all(isinstance(part, str | int | float | bool) for part in parts):
                    raise _AbsentError("its code is not in the file")
                return _logged(": ".join(part if isinstance(part, str) else json.dumps(part) for part in parts))
        return self._assign(data, where)

    def _assign(self, data: Mapping[str, Any], where: NodePath) -> ActionData:
        values = data.get("assignment")
        if not isinstance(values, dict) or not values:
            raise _AbsentError("its code is not in the file")
        sound = {key: quoted(value) for key, value in values.items() if key in self.context}
        for key in values.keys() - sound.keys():
            self.lost((*where, "assignment", key), f"`{key}` is not in the context", f"declare `{key}` in `context`")
        if not sound:
            raise _AbsentError("it assigns nothing")
        kept = (key for key in sound if self.context[key] is not None)
        self.wide.update({key: {} for key in kept if kind_of(values[key]) != kind_of(self.context[key])})
        return {"assign": sound}

    def _sent(self, data: Mapping[str, Any]) -> dict[str, Any]:
        """Return the event of `raise`, `send` or `sendTo`, with its data, delay and id.

        Raises _AbsentError if the event is missing, or the delay or id is invalid.
        """
        event, delay, id = data.get("event"), data.get("delay"), data.get("id")
        fields = event if isinstance(event, dict) else {"type": event}
        name = fields.get("type")
        if not isinstance(name, str) or not name.strip():
            raise _AbsentError("its event is not in the file")
        body: dict[str, Any] = {"event": self.names.event(name)}
        if more := {key: quoted(value) for key, value in fields.items() if key != "type"}:
            body["data"] = more
        if delay is not None:
            if not is_number(delay) or not 0 <= delay < MAX_DELAY:
                raise _AbsentError(f"the delay `{delay}` is not a number of milliseconds")
            body["delay"] = duration(delay)
        if id is not None:
            body["id"] = _text(data, "id")
        return body

    def _recipient(self, kind: str, data: Mapping[str, Any]) -> str:
        """Return the actor that receives the event; empty for the machine itself, the default of version 4's `send`.

        Raises _AbsentError if the JSON contains no recipient.
        """
        to = data.get("to")
        if to is None and kind == "xstate.send":
            return ""
        if not isinstance(to, str) or not to.removeprefix("#_") or to == "#_internal":
            raise _AbsentError("its recipient is not in the file")
        return PARENT if to == f"#_{PARENT}" else self.names.actor(to.removeprefix("#_"))

    def do(self, steps: Any) -> list[ActionData] | None:
        """Return the `do` that Lumen wrote as an invocation, or None if it is no longer valid."""
        return steps if isinstance(steps, list) and self.fits({"do": steps}) else None

    def fits(self, state: Mapping[str, Any]) -> bool:
        """Return whether a state with only this data has no errors, apart from unknown states."""
        data = {**self.surroundings, "context": self.context, "states": {"a": dict(state)}}
        document, found = plain_document("machine", data)
        if document is None:
            return False
        report = DocumentReport(document)
        build_machine(check_schema(document, "behavior", report), report, name="machine")
        return not has_errors([*found, *(d for d in report.diagnostics if d.code != "unknown-state")])

    def guard(self, data: Any, where: NodePath) -> str | None:
        """Return a guard as a Lumen expression; report an invalid one and return None.

        A name without code is reported, and becomes a context key.
        """
        kind = data.get("type") if isinstance(data, dict) else data
        params = data.get("params") if isinstance(data, dict) else None
        if not isinstance(kind, str) or not kind:
            self.lost(where, "this is not a guard", 'write "name" or {"type": "name"}')
            return None
        if kind == EXPRESSION_GUARD and isinstance(params, dict) and isinstance(params.get("source"), str):
            if self.fits({"always": {"target": "a", "guard": params["source"]}}):
                return str(params["source"])
            self.lost(where, f"the condition `{params['source']}` can't be read")
            return None
        return f"context.{self._placeholder(kind, data, where)}"

    def heard(self, data: Any, where: NodePath) -> TransitionData | None:
        """Return a `hears` row's key and guard from a guard that Lumen wrote; report an invalid one and return None."""
        params = data.get("params") if isinstance(data, dict) else None
        key, source = (params.get("row"), params.get("source")) if isinstance(params, dict) else (None, None)
        if isinstance(key, str) and key:
            guard = {} if source is None else {"guard": source}
            if self.fits({"hears": {key: {"target": "a", **guard}}}):
                return {"hears": key, **guard}
        self.lost(where, f"the row `{key}` of `hears` can't be read", 'write {"row": KEY}, and its guard as "source"')
        return None

    def _placeholder(self, kind: str, data: Any, where: NodePath) -> str:
        named = shown_name(kind, data)
        key = self._guards.get(named)
        if key is None:
            stem = re.sub(r"^(?=\d)", "_", _UNFIT.sub("_", kind)) or "_"
            number, key = 1, stem
            while key in self.context:
                number += 1
                key = f"{stem}_{number}"
            self._guards[named] = key
            self.context[key] = False
        condition = "the condition" if named == kind else f"`{named}`"
        hint = f"write {condition} instead of `context.{key}`, which is false"
        self.lost(where, f"the code of the guard `{kind}` is not in the file", hint)
        return key

    def delay(self, text: str, where: NodePath) -> str | None:
        """Convert a delay in milliseconds to a Lumen duration; report any other text and return None."""
        try:
            length = float(text)
        except ValueError:
            length = -1.0
        if not 0 <= length < 1e15:
            self.lost(where, f"the code of the delay `{text}` is not in the file", "write milliseconds")
            return None
        return duration(length)


class _AbsentError(Exception):
    """A built-in action is incomplete in the JSON; the message names the missing part."""


def _text(data: Mapping[str, Any], key: str) -> str:
    """Return a key's string or number as text. Raises _AbsentError if the key has neither."""
    value = data.get(key)
    if isinstance(value, bool) or not isinstance(value, str | int | float) or value == "":
        raise _AbsentError(f"`{key}` is not in the file")
    return str(value)


def _logged(text: str) -> ActionData:
    return {"log": re.sub(r"\{(?=\{)", "{{ '{' }}", text)}


def shown_name(kind: str, data: Any) -> str:
    """Return the name of an action, guard or actor, and its parameters as JSON, which version 4 has beside `type`."""
    params = data.get("params") if isinstance(data, dict) else None
    rest = data.items() if isinstance(data, dict) else ()
    beside = {key: value for key, value in rest if key not in ("type", "params")}
    parts = [kind, *(json.dumps(part, ensure_ascii=False) for part in (params, beside or None) if part is not None)]
    return " ".join(parts)

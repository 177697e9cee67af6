"""Actions, guards and delays of XState: names whose code lies elsewhere, and those that Lumen wrote."""

import json
import re
from collections.abc import Mapping
from typing import Any

from lumen.formats.behavior_data import ActionData, TransitionData
from lumen.formats.conversion_findings import ConversionFindings
from lumen.formats.durations import duration
from lumen.formats.xstate.descriptors import invoke_id
from lumen.formats.xstate.json_source import JsonSource
from lumen.language.actions import PARENT
from lumen.language.diagnostics import NodePath, has_errors
from lumen.loading.behaviors import build_machine
from lumen.loading.document_report import DocumentReport
from lumen.loading.plain import plain_document
from lumen.loading.schema import check_schema

EXPRESSION_GUARD = "lumen.expression"
HEARS_GUARD = "lumen.hears"
DO_ACTOR = "lumen.do"
ACTION_PREFIX = "lumen."
_UNFIT = re.compile(r"\W+", re.ASCII)


class XStateActionReader:
    """Reads what stands in the states of one file; `context` gets a key for every guard whose code is not there."""

    def __init__(self, source: JsonSource, context: dict[str, Any], findings: ConversionFindings) -> None:
        self.source, self.context, self.findings = source, context, findings
        self.surroundings: dict[str, Any] = {}
        self.row = ""
        """The key of the row of `hears` whose actions are read, empty for other transitions."""
        self._guards: dict[str, str] = {}

    def lost(self, where: NodePath, message: str, hint: str = "") -> None:
        self.findings.lost(self.source.place(where), message, hint)

    def changed(self, where: NodePath, message: str, hint: str = "") -> None:
        self.findings.changed(self.source.place(where), message, hint)

    def actions(self, data: Any, where: NodePath) -> list[ActionData]:
        """A name, an object, or a list of these."""
        if data is None:
            return []
        rows = [((*where, i), row) for i, row in enumerate(data)] if isinstance(data, list) else [(where, data)]
        return [action for place, row in rows if (action := self._action(row, place))]

    def _action(self, data: Any, where: NodePath) -> ActionData | None:
        kind = data.get("type") if isinstance(data, dict) else data
        if data is None:
            self.lost(where, "an action is null: JSON has no place for its code", "give it a name in `setup`")
            return None
        if not isinstance(kind, str):
            self.lost(where, "this is no action", 'write "name" or {"type": "name", "params": …}')
            return None
        params = data.get("params") if isinstance(data, dict) else None
        if kind.startswith(ACTION_PREFIX) and (own := self._own(kind.removeprefix(ACTION_PREFIX), params)):
            return own
        if kind == "xstate.raise" and isinstance(data, dict) and (own := self._raise(data)):
            return own
        if kind in ("xstate.sendTo", "xstate.send") and isinstance(data, dict) and (own := self._send_to(data)):
            return own
        shown = kind if params is None else f"{kind} {json.dumps(params, ensure_ascii=False)}"
        self.lost(where, f"the code of the action `{kind}` is not in the file", "a line in the log stands for it")
        return {"log": re.sub(r"\{(?=\{)", "{{ '{' }}", shown)}

    def _own(self, verb: str, params: Any) -> ActionData | None:
        """An action that Lumen wrote; None where somebody changed it into something else."""
        if verb == "if" and isinstance(params, dict):
            action = params
        else:
            action = {verb: params["value"] if isinstance(params, dict) and set(params) == {"value"} else params}
        around = {"hears": {self.row: {"actions": [action]}}} if self.row else {"entry": [action]}
        return action if self.fits(around) else None

    def _raise(self, data: Mapping[str, Any]) -> ActionData | None:
        body = _sent(data)
        if body is None:
            return None
        return {"send": body} if "delay" in body else {"raise": body["event"]}

    def _send_to(self, data: Mapping[str, Any]) -> ActionData | None:
        """What goes to another actor, where JSON can name it: `sendTo` of version 5, `send` with `to` of version 4."""
        to, body = data.get("to"), _sent(data)
        if body is None or not isinstance(to, str) or not to.removeprefix("#_") or to == "#_internal":
            return None
        return {"send": body | {"to": PARENT if to == f"#_{PARENT}" else invoke_id(to.removeprefix("#_"))}}

    def do(self, steps: Any) -> list[ActionData] | None:
        """The `do` that Lumen wrote as an invocation."""
        return steps if isinstance(steps, list) and self.fits({"do": steps}) else None

    def fits(self, state: Mapping[str, Any]) -> bool:
        """Whether a state with this and no more would be without errors."""
        data = {**self.surroundings, "context": self.context, "states": {"a": dict(state)}}
        document, found = plain_document("machine", data)
        if document is None:
            return False
        report = DocumentReport(document)
        build_machine(check_schema(document, "behavior", report), report, name="machine")
        return not has_errors([*found, *(d for d in report.diagnostics if d.code != "unknown-state")])

    def guard(self, data: Any, where: NodePath) -> str | None:
        """Our expression, None (and reported) where this is no guard."""
        kind = data.get("type") if isinstance(data, dict) else data
        params = data.get("params") if isinstance(data, dict) else None
        if not isinstance(kind, str) or not kind:
            self.lost(where, "this is no guard", 'write "name" or {"type": "name"}')
            return None
        if kind == EXPRESSION_GUARD and isinstance(params, dict) and isinstance(params.get("source"), str):
            if self.fits({"always": {"target": "a", "guard": params["source"]}}):
                return str(params["source"])
            self.lost(where, f"the condition `{params['source']}` can't be read")
            return None
        return f"context.{self._placeholder(kind, params, where)}"

    def heard(self, data: Any, where: NodePath) -> TransitionData | None:
        """The key of a row of `hears`, and its own guard, from the guard that Lumen wrote; None if that is broken."""
        params = data.get("params") if isinstance(data, dict) else None
        key, source = (params.get("row"), params.get("source")) if isinstance(params, dict) else (None, None)
        if isinstance(key, str) and key:
            guard = {} if source is None else {"guard": source}
            if self.fits({"hears": {key: {"target": "a", **guard}}}):
                return {"hears": key, **guard}
        self.lost(where, f"the row `{key}` of `hears` can't be read", 'write {"row": KEY}, and its guard as "source"')
        return None

    def _placeholder(self, kind: str, params: Any, where: NodePath) -> str:
        named = kind if params is None else f"{kind} {json.dumps(params, ensure_ascii=False)}"
        key = self._guards.get(named)
        if key is None:
            stem = re.sub(r"^(?=\d)", "_", _UNFIT.sub("_", kind)) or "_"
            number, key = 1, stem
            while key in self.context:
                number += 1
                key = f"{stem}_{number}"
            self._guards[named] = key
            self.context[key] = False
        hint = f"write the condition in place of `context.{key}`, which is false"
        self.lost(where, f"the code of the guard `{kind}` is not in the file", hint)
        return key

    def delay(self, text: str, where: NodePath) -> str | None:
        """A key of `after`: milliseconds."""
        try:
            length = float(text)
        except ValueError:
            length = -1.0
        if not 0 <= length < 1e15:
            self.lost(where, f"the code of the delay `{text}` is not in the file", "write milliseconds")
            return None
        return duration(length)


def _sent(data: Mapping[str, Any]) -> dict[str, Any] | None:
    """The event of `raise` and `sendTo` with its delay and its id; None where they hold more than JSON can say."""
    event, delay, id = data.get("event"), data.get("delay"), data.get("id")
    name = event.get("type") if isinstance(event, dict) else None
    if not isinstance(name, str) or len(event or {}) > 1:
        return None
    if delay is None:
        return {"event": name}
    if isinstance(delay, bool) or not isinstance(delay, int | float) or delay < 0:
        return None
    return {"event": name, "delay": duration(delay)} | ({"id": id} if isinstance(id, str) and id else {})

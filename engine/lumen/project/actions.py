"""The actions of a behaviour, in `entry`, `do`, `exit` and `actions`: one verb each."""

from collections.abc import Callable, Mapping
from typing import Any, assert_never

from lumen.feature import VerbRow
from lumen.language.actions import (
    Action,
    AskQuestion,
    Assign,
    CancelSend,
    If,
    LogText,
    Parallel,
    PlacedAction,
    PublishBody,
    Raise,
    SayText,
    Send,
    Template,
    Wait,
    context_key,
)
from lumen.language.added_verbs import arguments_of, durations_of, with_texts
from lumen.language.commands import Do, SaysGestures, VerbCommand
from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.language.durations import duration_hint
from lumen.language.verbs import Quantity, Verb, verb_named
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.complaints import MISSING_KEY
from lumen.project.document_report import DocumentReport
from lumen.project.expressions import Expressions
from lumen.project.numbers import finite
from lumen.project.units import ANGLES, BAD_DURATION, LENGTHS, seconds

ONLY_IN_DO = Code("only-in-do", "statecharts", ERROR, "a verb that waits is used outside `do`")


class Actions:
    """Reads the actions of one document; `units` are declared in its file, `verbs` in the project."""

    def __init__(
        self,
        report: DocumentReport,
        expressions: Expressions,
        units: Mapping[str, str],
        verbs: OwnVerbs = NO_VERBS,
    ) -> None:
        self.report, self.expressions, self.verbs = report, expressions, verbs
        self.angle = ANGLES.get(units.get("angle", "rad"), 1.0)
        self.length = LENGTHS.get(units.get("length", "m"), 1.0)

    def block(self, data: Any, where: NodePath, *, do: bool = False) -> tuple[PlacedAction, ...]:
        """Return the actions in `data`: one action, a list of them, or None for no actions.

        Actions that can't be read are left out. `do` allows `wait`, `parallel` and `ask`.
        """
        if isinstance(data, Mapping):
            action = self.action(data, where, do=do)
            return (PlacedAction(action, where),) if action else ()
        rows = [((*where, i), item) for i, item in enumerate(data or ())]
        return tuple(PlacedAction(a, place) for place, item in rows if (a := self.action(item, place, do=do)))

    def action(self, data: Mapping[str, Any], where: NodePath, *, do: bool = False) -> Action | None:
        """Return one action; None if it can't be read. Faults that the file's schema does not show are reported.

        `do` is true within the `do` of a state, where more verbs are allowed.
        """
        if "if" in data:
            return self._if(data, where, do=do)
        if len(data) != 1:
            return None
        [(verb, body)] = data.items()
        if verb in ("wait", "parallel", "ask") and not do:
            hint = "move it into the `do` of a state" + (
                ", or `send` an event with a `delay`" if verb == "wait" else ""
            )
            self.report(ONLY_IN_DO, (*where, verb), f"`{verb}` is allowed only in `do`", hint=hint, key=True)
            return None
        return self._verb(verb, body, (*where, verb))

    def duration(self, text: Any, where: NodePath, *, key: bool = False) -> float | None:
        """Return the duration [s] in a text such as `20s`; if it can't be read, report the fault and return None."""
        if (length := seconds(text)) is None:
            self.report(BAD_DURATION, where, f"`{text}` is not a duration", hint=duration_hint(text), key=key)
        return length

    def delay(self, text: Any, where: NodePath, *, key: bool = False) -> float | Template | None:
        """Return a delay [s], or the template that computes it; for any other text, report that and return None."""
        if isinstance(text, str) and "{{" in text:
            return self.expressions.template(text, where)
        return self.duration(text, where, key=key)

    def _verb(self, verb: str, data: Any, where: NodePath) -> Action | None:
        if read := COMPUTED_READERS.get(verb):
            return read(self, data, where)
        if row := verb_named(verb, data):
            return self._command(row, data, where)
        added = self.verbs.all.get(verb)
        return self._do(verb, added, data, where) if added else None

    def _do(self, verb: str, row: VerbRow, data: Any, where: NodePath) -> Do | None:
        """Return the command of an added verb; if a duration or template is faulty, report that and return None."""
        sound = True

        def read(text: str, below: NodePath) -> str:
            nonlocal sound
            place = (*where, *below) if isinstance(data, Mapping) else where
            if "{{" in text:
                template = self.expressions.template(text, place)
                sound = sound and template is not None
                return template.text if template else text
            if below[:1] in durations and len(below) == 1:
                sound = self.duration(text, place) is not None and sound
            return text

        durations = {(name,) for name in durations_of(row)}
        arguments = with_texts(arguments_of(row, data), read)
        return Do(verb, arguments, row=self.verbs.rows.get(verb)) if sound else None

    def _command(self, row: Verb[Any], data: Any, where: NodePath) -> VerbCommand | None:
        """Return the command of this row; if a value in it can't be read, report the fault and return None."""
        values = {}
        for field, below, value in row.arguments(data):
            values[field.name] = self._value(field.quantity, value, (*where, *below))
        return None if None in values.values() else row.command(**values)

    def _value(self, quantity: Quantity, value: Any, where: NodePath) -> Any:
        """Return the value in the command's units; if it can't be read, report the fault and return None."""
        if isinstance(value, int | float) and not finite(value, self.report, where):
            return None
        match quantity:
            case Quantity.PLAIN:
                return value
            case Quantity.LENGTH:
                return value * self.length
            case Quantity.ANGLE:
                return value * self.angle
            case Quantity.DURATION:
                return self.duration(value, where)
            case Quantity.TEMPLATE:
                template = self.expressions.template(value, where)
                return template.text if template else None
            case _:
                assert_never(quantity)

    def _publish(self, data: Any, where: NodePath) -> PublishBody:
        route, value = (data, None) if isinstance(data, str) else (data["route"], data.get("body"))
        return PublishBody(route, self.expressions.value(value, (*where, "body")))

    def _raise(self, data: Any, where: NodePath) -> Raise:
        event, value = _event(data)
        return Raise(event, self.expressions.value(value, (*where, "data")))

    def _cancel(self, data: str, where: NodePath) -> CancelSend:
        return CancelSend(data)

    def _log(self, data: str, where: NodePath) -> LogText | None:
        text = self.expressions.template(data, where)
        return LogText(text) if text else None

    def _wait(self, data: Any, where: NodePath) -> Wait | None:
        length = self.duration(data, where)
        return None if length is None else Wait(length)

    def _parallel(self, data: Any, where: NodePath) -> Parallel:
        return Parallel(self.block(data, where, do=True))

    def _ask(self, data: Mapping[str, Any], where: NodePath) -> AskQuestion | None:
        question = self.expressions.expression(data["question"], (*where, "question"))
        within = self.duration(data["within"], (*where, "within"))
        otherwise = self.block(data["else"], (*where, "else"), do=True)
        return None if question is None or within is None else AskQuestion(question, within, otherwise)

    def _say(self, body: Any, where: NodePath) -> SayText | None:
        table = {"any": body} if isinstance(body, str) else body
        texts: dict[str, tuple[Template, ...]] = {}
        gestures: SaysGestures = "none" if "gestures" in table else ""
        if table.keys() == {"gestures"}:
            self.report(
                MISSING_KEY, where, "there is no text to speak here", hint="add a text, or `any:` with a list of texts"
            )
        for language, said in table.items():
            if language == "gestures":
                continue
            place = where if isinstance(body, str) else (*where, language)
            rows = [(place, said)] if isinstance(said, str) else [((*place, i), t) for i, t in enumerate(said)]
            read = tuple(t for at, text in rows if (t := self.expressions.template(text, at)))
            if read:
                texts["" if language == "any" else language] = read
        return SayText(texts, gestures) if texts else None

    def _assign(self, body: Mapping[str, Any], where: NodePath) -> Assign | None:
        known = {k: v for k, v in body.items() if self.expressions.key(context_key(k), (*where, k))}
        values = {k: self.expressions.value(v, (*where, k)) for k, v in known.items()}
        return Assign(values) if values else None

    def _send(self, body: Any, where: NodePath) -> Send | None:
        event, data = _event(body)
        options = {} if isinstance(body, str) else body
        delay = self.delay(options["delay"], (*where, "delay")) if "delay" in options else 0.0
        if delay is None:
            return None
        return Send(
            event, self.expressions.value(data, (*where, "data")), delay, options.get("id", ""), options.get("to", "")
        )

    def _if(self, data: Mapping[str, Any], where: NodePath, *, do: bool) -> If | None:
        guard = self.expressions.expression(data["if"], (*where, "if"))
        then = self.block(data.get("then"), (*where, "then"), do=do)
        otherwise = self.block(data.get("else"), (*where, "else"), do=do)
        return If(guard, then, otherwise) if guard else None


def _event(body: Any) -> tuple[str, Any]:
    return (body, None) if isinstance(body, str) else (body["event"], body.get("data"))


COMPUTED_READERS: Mapping[str, Callable[[Actions, Any, NodePath], Action | None]] = {
    "say": Actions._say,
    "assign": Actions._assign,
    "publish": Actions._publish,
    "raise": Actions._raise,
    "send": Actions._send,
    "cancel": Actions._cancel,
    "log": Actions._log,
    "wait": Actions._wait,
    "parallel": Actions._parallel,
    "ask": Actions._ask,
}
"""The readers of verbs that are not in the table of verbs, by verb. `if` is missing: it has other keys beside it."""

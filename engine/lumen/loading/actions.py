"""Actions of a behaviour: what stands in `entry`, `do`, `exit` and `actions`, one verb each."""

from collections.abc import Mapping
from typing import Any

from lumen.language.actions import (
    Action,
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
)
from lumen.language.commands import Language, Look, Move, Play, Posture, Rest, Stop, Track, Wake, Walk
from lumen.language.diagnostics import NodePath
from lumen.loading.expressions import Expressions
from lumen.loading.numbers import finite
from lumen.loading.source import DocumentReport
from lumen.loading.units import ANGLES, LENGTHS, seconds

DURATION_HINT = "write a number and its unit, such as `500ms`, `20s` or `2min`"


class Actions:
    """Reads the actions of one document; `units` are the file's."""

    def __init__(self, report: DocumentReport, expressions: Expressions, units: Mapping[str, str]) -> None:
        self.report, self.expressions = report, expressions
        self.angle = ANGLES.get(units.get("angle", "rad"), 1.0)
        self.length = LENGTHS.get(units.get("length", "m"), 1.0)

    def block(self, data: Any, where: NodePath, *, do: bool = False) -> tuple[PlacedAction, ...]:
        """A single action or a list of them; `do` allows `wait` and `parallel`. Broken ones are left out."""
        if isinstance(data, Mapping):
            action = self.action(data, where, do=do)
            return (PlacedAction(action, where),) if action else ()
        rows = [((*where, i), item) for i, item in enumerate(data or ())]
        return tuple(PlacedAction(a, place) for place, item in rows if (a := self.action(item, place, do=do)))

    def action(self, data: Mapping[str, Any], where: NodePath, *, do: bool = False) -> Action | None:
        """One action, None (and reported) where it can't be read."""
        if "if" in data:
            return self._if(data, where, do=do)
        if len(data) != 1:
            return None
        [(verb, body)] = data.items()
        if verb in ("wait", "parallel") and not do:
            hint = "move it into the `do` of a state" + (
                ", or `send` an event with a `delay`" if verb == "wait" else ""
            )
            self.report("only-in-do", (*where, verb), f"`{verb}` can stand only in `do`", hint=hint, key=True)
            return None
        return self._verb(verb, body, (*where, verb))

    def duration(self, text: Any, where: NodePath, *, key: bool = False) -> float | None:
        """[s], None (and reported) where the text is no duration."""
        if (length := seconds(text)) is None:
            self.report("bad-duration", where, f"`{text}` is not a duration", hint=DURATION_HINT, key=key)
        return length

    def _verb(self, verb: str, body: Any, where: NodePath) -> Action | None:
        match verb:
            case "say":
                return self._say(body, where)
            case "assign":
                return self._assign(body, where)
            case "publish":
                route, value = (body, None) if isinstance(body, str) else (body["route"], body.get("body"))
                return PublishBody(route, self.expressions.value(value, (*where, "body")))
            case "raise":
                event, data = _event(body)
                return Raise(event, self.expressions.value(data, (*where, "data")))
            case "send":
                return self._send(body, where)
            case "cancel":
                return CancelSend(body)
            case "log":
                text = self.expressions.template(body, where)
                return LogText(text) if text else None
            case "wait":
                length = self.duration(body, where)
                return None if length is None else Wait(length)
            case "parallel":
                return Parallel(self.block(body, where, do=True))
        return self._motor(verb, body, where)

    def _motor(self, verb: str, body: Any, where: NodePath) -> Action | None:
        if not self._finite(body, where):
            return None
        match verb:
            case "play":
                return Play(body)
            case "posture":
                return Posture(body) if isinstance(body, str) else Posture(body["name"], body.get("speed", 0.5))
            case "walk" if body.keys() & {"vx", "vy", "vtheta"}:
                vx, vy = (body.get(k, 0.0) * self.length for k in ("vx", "vy"))
                return Move(vx, vy, body.get("vtheta", 0.0) * self.angle)
            case "walk":
                x, y = (body.get(k, 0.0) * self.length for k in ("x", "y"))
                return Walk(x, y, body.get("theta", 0.0) * self.angle)
            case "look":
                return Look(*(body.get(k, 0.0) * self.angle for k in ("yaw", "pitch")))
            case "track":
                return Track(body) if isinstance(body, str) else Track(*next(iter(body.items())))
            case "stop":
                return Stop(body)
            case "rest":
                return Rest()
            case "wake":
                return Wake()
            case "language":
                return Language(body)
        return None

    def _finite(self, body: Any, where: NodePath) -> bool:
        """Whether every number of a motor's action can be gone to; reported where not."""
        numbers = body.items() if isinstance(body, Mapping) else ()
        return all(finite(n, self.report, (*where, k)) for k, n in numbers if isinstance(n, int | float))

    def _say(self, body: Any, where: NodePath) -> SayText | None:
        table = {"any": body} if isinstance(body, str) else body
        texts: dict[str, tuple[Template, ...]] = {}
        for language, said in table.items():
            place = where if isinstance(body, str) else (*where, language)
            rows = [(place, said)] if isinstance(said, str) else [((*place, i), t) for i, t in enumerate(said)]
            read = tuple(t for at, text in rows if (t := self.expressions.template(text, at)))
            if read:
                texts["" if language == "any" else language] = read
        return SayText(texts) if texts else None

    def _assign(self, body: Mapping[str, Any], where: NodePath) -> Assign | None:
        known = {k: v for k, v in body.items() if self.expressions.key(k, (*where, k))}
        values = {k: self.expressions.value(v, (*where, k)) for k, v in known.items()}
        return Assign(values) if values else None

    def _send(self, body: Any, where: NodePath) -> Send | None:
        event, data = _event(body)
        options = {} if isinstance(body, str) else body
        delay = self.duration(options["delay"], (*where, "delay")) if "delay" in options else 0.0
        if delay is None:
            return None
        return Send(event, self.expressions.value(data, (*where, "data")), delay, options.get("id", ""))

    def _if(self, data: Mapping[str, Any], where: NodePath, *, do: bool) -> If | None:
        guard = self.expressions.expression(data["if"], (*where, "if"))
        then = self.block(data.get("then"), (*where, "then"), do=do)
        otherwise = self.block(data.get("else"), (*where, "else"), do=do)
        return If(guard, then, otherwise) if guard else None


def _event(body: Any) -> tuple[str, Any]:
    return (body, None) if isinstance(body, str) else (body["event"], body.get("data"))

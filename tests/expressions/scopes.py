"""A scope as a tour has it, for the tables of these tests."""

from lumen.expressions import Scope
from lumen.language.machines import Answer

PHRASES = {
    "no": {"en": ("no", "nope"), "id": ("tidak",)},
    "dance": {"en": ("dance", "can you dance"), "id": ("menari", "joget")},
    "good": {"en": ("don't worry",), "id": ("baik",)},
    "empty": {"en": ("", "?!")},
}
ANSWERS = {
    "faq": (
        Answer({"en": ("how tall",), "id": ("tinggi",)}, {"en": "I am 57 cm tall.", "id": "Tinggi saya 57 cm."}),
        Answer({"en": ("your name",), "id": ("nama",)}, "Lumen"),
        Answer({"en": ("who made you",)}, {"en": "The faculty.", "id": "Fakultas."}),
        Answer({"en": ("price",)}, {"id": 5, "text": "Five."}),
        Answer({"en": ("your name again",)}, "never reached"),
    )
}
SCOPE = Scope(
    context={
        "n": 2, "x": 1.5, "yes": True, "name": "Ada", "none": None, "list": [1, "a", [True]], "map": {"a": {"b": 1}},
        "long": "no " * 2000, "big": 2**63 - 1, "empty": "", "visitor": {"first-name": "Ada"}, "texts": ("a", "b"),
    },
    event={"name": "heard", "data": {"result": "I know. What's your NAME?", "ok": True, "null": None}},
    state={"path": "talk.ask", "language": "en"},
    configuration=lambda state: state in ("talk", "talk.ask"),
    at=5400.0,
    epoch=3600.0 * 23,
    language="en",
    phrases=PHRASES,
    answers=ANSWERS,
)  # fmt: skip

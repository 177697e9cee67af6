"""Phrases are heard as whole words, in every language, whatever the case and the punctuation."""

from lumen.expressions import Scope, compile_expression
from lumen.language.machines import Answer
from tests.expressions.scopes import SCOPE
from tests.tables import for_each


def heard(text: str, *phrases: str) -> bool:
    scope = Scope(context={"text": text}, phrases={"p": {"en": (), "xx": phrases}})
    return bool(compile_expression("heard(context.text, 'p')")(scope))


@for_each(
    ("text", "phrase"),
    [
        ("no", "no"),
        ("No, thanks!", "no"),
        ("NO!", "no"),
        ("oh no", "No"),
        ("well...no?", "no"),
        ("¿no?", "no"),
        ("can you   DANCE\tfor\nme", "dance for me"),
        ("Dance, for me", "dance for me"),
        ("don’t worry", "don't worry"),
        ("dont worry", "don't worry"),
        ("'hello'", "hello"),
        ("baik-baik saja", "baik"),
        ("baik baik", "baik-baik"),
        ("STRASSE", "straße"),
        ("cafe\u0301 now", "café"),
        ("Ｌｕｍｅｎ", "lumen"),
        ("İstanbul", "i̇stanbul"),
        ("что это", "ЭТО"),
        ("नमस्ते दुनिया", "नमस्ते"),
        ("room 12", "12"),
        ("a_b", "b"),
        ("no 🤖", "no"),
    ],
)
def test_heard(text: str, phrase: str) -> None:
    assert heard(text, phrase)


@for_each(
    ("text", "phrase"),
    [
        ("I know", "no"),
        ("nobody", "no"),
        ("", "no"),
        ("no", ""),
        ("no", "?!"),
        ("?!", "?!"),
        ("dancer", "dance"),
        ("can dance you", "can you dance"),
        ("don't", "don"),
        ("нет", "не"),
        ("हिन्दी", "हिन"),
        ("cafe\u0301", "caf"),
    ],
)
def test_not_heard(text: str, phrase: str) -> None:
    assert not heard(text, phrase)


def test_any_phrase_of_any_language() -> None:
    assert heard("joget dong", "dance", "joget")
    evaluate = compile_expression("[heard('joget', 'dance'), heard('DANCE', 'dance'), heard('tari', 'dance')]")
    assert evaluate(SCOPE) == [True, True, False]
    assert compile_expression("heard('anything', 'empty')")(SCOPE) is False


def test_texts_are_cut() -> None:
    assert heard("x " * 499 + "no", "no")
    assert not heard("x " * 500 + "no", "no")
    assert compile_expression("contains(context.long, 'nope') || size(lower(context.long)) != 1000")(SCOPE) is False


@for_each(
    ("text", "language", "value"),
    [
        ("How tall are you?", "en", "I am 57 cm tall."),
        ("How tall are you?", "id", "Tinggi saya 57 cm."),
        ("tinggi?", "en", "I am 57 cm tall."),
        ("how tall", "fr", "I am 57 cm tall."),
        ("how taller", "en", None),
        ("what is your name again", "en", "Lumen"),
        ("who made you, and how tall", "en", "I am 57 cm tall."),
        ("the price, please", "id", {"id": 5, "text": "Five."}),
        ("who made you", "id", "Fakultas."),
    ],
)
def test_lookup(text: str, language: str, value: object) -> None:
    scope = SCOPE._replace(context={"text": text}, language=language)
    assert compile_expression("lookup(context.text, 'faq')")(scope) == value


def test_lookup_of_other_tables() -> None:
    """Data prepared from a table belongs to that table only, however many tables there are."""
    for n in range(600):
        answers = {"t": (Answer({"en": (f"word{n}",)}, n),)}
        scope = Scope(context={"text": f"say word{n}"}, answers=answers, phrases={"p": {"en": (f"word{n}",)}})
        assert compile_expression("heard(context.text, 'p') ? lookup(context.text, 't') : null")(scope) == n


@for_each(
    ("text", "phrase", "rest"),
    [
        ("my name is Ada", "my name is", "Ada"),
        ("Hello! My  NAME is: Ada Lovelace.", "my name is", "Ada Lovelace"),
        ("Ada", "my name is", ""),
        ("my name is", "my name is", ""),
        ("my name isn't Ada", "my name is", ""),
        ("nama saya Sari", "Nama saya", "Sari"),
        ("I'm Ada, hi!", "im", "Ada, hi"),
        ("a b a b c", "a b", "a b c"),
        ("call me Jean-Luc", "call me", "Jean-Luc"),
        ("it is O'Neil", "it is", "O'Neil"),
        ("x", "", ""),
        ("my name is\u00a0Zoë…", "my name is", "Zoë"),
        ("STRASSE weg", "straße", "weg"),
        ("½ a", "1⁄2", "a"),
    ],
)
def test_after(text: str, phrase: str, rest: str) -> None:
    scope = Scope(context={"text": text, "phrase": phrase})
    assert compile_expression("after(context.text, context.phrase)")(scope) == rest


@for_each(
    ("text", "words"),
    [
        ("", []),
        (" ?! ", []),
        ("Don't stop", ["Don't", "stop"]),
        ("'quoted'", ["quoted"]),
        ("a-b, c.d", ["a", "b", "c", "d"]),
        ("' x", ["x"]),
    ],
)
def test_words(text: str, words: list[str]) -> None:
    assert compile_expression("words(context.text)")(Scope(context={"text": text})) == words

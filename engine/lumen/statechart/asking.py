"""Questions of visitors and their answers: names are removed from questions, and control characters from answers."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.expressions import Scope, compile_expression
from lumen.language.actions import AskQuestion
from lumen.language.commands import Ask, BodyCommand, Say
from lumen.language.modules import VISITOR_KEY
from lumen.language.people import PersonName
from lumen.statechart.action_context import ActionContext, ActionError

MAX_QUESTION = 1_000
"""The greatest length of a question [characters]; the rest is cut off."""
MAX_SENTENCE = 500
"""The greatest length of a sentence of an answer [characters]; a longer one is ignored."""
MAX_SENTENCES = 5
"""The greatest number of sentences of one answer that are said, each when it arrives."""
MAX_NAME = 60
"""The greatest length of a text that may be a name [characters]."""
MARKUP = str.maketrans(dict.fromkeys("\\^<>{}[]|`*_#~\n\r\t", " "))
"""Characters that a voice may take for commands, such as NAOqi's `^start(…)` and `\\rspd=…\\`; each becomes a space."""


class Sentence(NamedTuple):
    """One sentence of an answer, or the event that the answer raises."""

    text: str
    """The words to say; empty for an event."""
    language: str = ""
    """The language of the words; empty for the current language."""
    more: bool = False
    """True if more of the answer follows."""
    filler: bool = False
    """True for words that only bridge the time until the answer."""
    raises: str = ""
    """The name of the event to raise instead of speech; empty for none."""
    data: Any = None
    """The data of that event."""


def compile_question(action: AskQuestion) -> Callable[[Scope], BodyCommand]:
    """Return a function that makes the Ask command; it raises ActionError if the question is not a string."""
    asked = compile_expression(action.question.source)

    def ask(scope: Scope) -> BodyCommand:
        question = asked(scope)
        if not isinstance(question, str):
            raise ActionError(f"the question is not a string: {question!r}")
        known = "".join(sign if sign.isprintable() else " " for sign in question[:MAX_QUESTION])
        return Ask(" ".join(unnamed(known, scope.context).split()), scope.language, action.within, _place(scope))

    return ask


def unnamed(text: str, context: Mapping[str, Any]) -> str:
    """Return the text without the visitor's name and without texts of the context that are written like names."""
    for name in sorted(dict.fromkeys(_names(context)), key=len, reverse=True):
        text = PersonName(name).taken_from(text)
    return text


def sentence_of(data: Any) -> Sentence | None:
    """Return the sentence in the data of an `answer` event, None if the data is malformed.

    The text is never used as a template, and characters that a voice may interpret as commands become spaces.
    """
    if not isinstance(data, Mapping):
        return None
    if isinstance(raised := data.get("raise"), Mapping):
        event = raised.get("event")
        return Sentence("", raises=event, data=raised.get("data")) if isinstance(event, str) and event else None
    if not isinstance(text := data.get("text"), str) or len(text) > MAX_SENTENCE:
        return None
    said = " ".join("".join(sign if sign.isprintable() else " " for sign in text.translate(MARKUP)).split())
    language = data.get("language")
    if not any(sign.isalnum() for sign in said):
        return None
    return Sentence(
        said, language if isinstance(language, str) else "", data.get("more") is True, data.get("filler") is True
    )


def spoken(context: ActionContext, sentence: Sentence) -> BodyCommand:
    """Return the command that says the sentence."""
    return Say(sentence.text, sentence.language or context.language)


def _names(context: Mapping[str, Any]) -> Iterator[str]:
    visitor = context.get(VISITOR_KEY)
    if isinstance(visitor, str) and visitor.strip():
        yield from (visitor, *visitor.split())
    for value in context.values():
        yield from _written_as_names(value)


def _written_as_names(value: Any) -> Iterator[str]:
    """Yield the texts of at most four words, each with an initial capital letter, in a value or nested in it."""
    match value:
        case str():
            words = value.split()
            if 0 < len(words) <= 4 and len(value) <= MAX_NAME and all(word[0].isupper() for word in words):
                yield value
        case Mapping():
            for inner in value.values():
                yield from _written_as_names(inner)
        case list() | tuple():
            for inner in value:
                yield from _written_as_names(inner)


def _place(scope: Scope) -> str:
    place = scope.state.get("place", "") if isinstance(scope.state, Mapping) else ""
    return place if isinstance(place, str) else ""

"""What ALTextToSpeech is given: the words, in a language that it has."""

from collections.abc import Sequence

LANGUAGE_NAMES = {
    "en": "English", "id": "Indonesian", "fr": "French", "de": "German", "es": "Spanish", "it": "Italian",
    "ja": "Japanese", "zh": "Chinese", "ko": "Korean", "nl": "Dutch", "pt": "Portuguese", "ar": "Arabic",
    "ru": "Russian", "tr": "Turkish", "pl": "Polish", "sv": "Swedish", "da": "Danish", "fi": "Finnish",
    "cs": "Czech", "el": "Greek", "nb": "Norwegian",
}  # fmt: skip
"""NAOqi's names of languages."""


def words(text: str) -> str:
    r"""The text without anything that the voice would take for an order to itself, such as `\vol=100\` or `^run(…)`.

    Visitors' names are in what is said, and `\…\` would change volume, speed or language from then on; `^…(…)` would
    have ALAnimatedSpeech start behaviours.
    """
    printable = "".join(sign if sign.isprintable() and sign not in "\\^" else " " for sign in text)
    return " ".join(printable.split())


def language_of(code: str, spoken: Sequence[str]) -> str:
    """NAOqi's name of the language, empty where the robot has no voice for it; `spoken` are those that it has."""
    name = LANGUAGE_NAMES.get(code.partition("-")[0].lower(), code)
    return name if name in spoken else ""

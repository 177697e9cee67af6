"""Permits a language model's sentences that are short, in the right language, and without facts of their own.

A sentence that can't be checked is refused, so the robot uses its answer for unknown questions.
"""

import re
import unicodedata
from collections.abc import Iterator, Sequence

MAX_LENGTH = 300
"""The maximum length of a sentence [characters]."""

COMMON = {
    "en": "a about also am an and any are as at be because but by can could do does for from good has have he hello"
    " here hi how i if in is it its just like many may me more most my no not of on one only or our out please see she"
    " so some sorry sure thank thanks that the their them then there these they this to too very was we welcome well"
    " were what when where which who why will with yes you your yours",
    "id": "ada adalah agar akan aku anda apa atau bagaimana bagi bahwa baik banyak belum bisa boleh bukan dalam dan"
    " dapat dari dengan di dia halo hanya harus ini itu iya jadi jangan juga kalau kami kamu karena kata ke kita lagi"
    " lebih maaf mana masih mereka oleh pada paling perlu punya saja sampai sangat satu saya sebagai sebuah sedang"
    " selamat semua seperti siapa silakan sudah tapi telah tentu tentang terima kasih tetapi tidak untuk ya yang",
    "de": "aber als am an auch auf aus bei bin bis das dass dem den der des die dies du ein eine einen er es für haben"
    " hat hier ich ihr im in ist ja kann kein man mein mich mir mit nach nein nicht noch nur oder sehr sein sich sie"
    " sind so und uns vom von vor war was wenn wer wie wir wo zu zum zur",
    "fr": "à au aussi avec bien ce ces cette comme dans de des dont du elle en est et être il ils je la le les leur"
    " mais me mes mon ne non nous on ou où oui par pas plus pour que qui sa se ses si son sont sur très tu un une vous",
    "es": "a al como con de del donde el ella en es esta este esto están hay la las lo los me mi muy más no nos o para"
    " pero por porque que quien se ser si sin sobre son su sus sí también te tu un una y yo él",
}
"""The most common words of each language, by which sentences in it are recognised."""
WORDS = {language: frozenset(words.split()) for language, words in COMMON.items()}

NUMBER_WORDS = {
    "en": "zero two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen"
    " eighteen nineteen twenty thirty forty fifty sixty seventy eighty ninety hundred hundreds thousand thousands"
    " million millions billion dozen half twice",
    "id": "nol dua tiga empat lima enam tujuh delapan sembilan sepuluh sebelas belas puluh puluhan ratus ratusan"
    " seratus ribu ribuan seribu juta jutaan sejuta miliar setengah",
    "de": "null zwei drei vier fünf sechs sieben acht neun zehn elf zwölf zwanzig hundert tausend million",
    "fr": "deux trois quatre cinq sept huit neuf dix onze douze vingt cent mille",
    "es": "dos tres cuatro cinco seis siete ocho nueve diez once doce veinte cien mil",
}
NUMBERS = frozenset(word for words in NUMBER_WORDS.values() for word in words.split())
"""Words for numbers, except for "one", which has other meanings."""
ADDRESS = re.compile(
    r"[@/\\]|\w\.\w{2,}|\b(?:www|http|dot|titik|com|org|net|street|avenue|road|jalan|jl|straße|rue|calle)\b"
    r"|\b(?:e-?mail|surel|phone|telepon|telefon|whatsapp)\b",
    re.IGNORECASE,
)
_END = re.compile(r"[.!?…]+[\"'”’)]*(?=\s|$)")


def sentences(text: str, *, ended: bool) -> tuple[list[str], str]:
    """Return the complete sentences of a text, and the rest. If the text has `ended`, the rest counts as a sentence."""
    found, at = [], 0
    for end in _END.finditer(text):
        if end.end() == len(text) and not ended:
            break  # more digits may follow, as in 3.5
        found.append(text[at : end.end()].strip())
        at = end.end()
    rest = text[at:]
    if ended:
        found, rest = [*found, rest.strip()], ""
    return [one for one in found if any(sign.isalnum() for sign in one)], rest


def refusal(sentence: str, language: str, passages: Sequence[str], known: Sequence[str] = ()) -> str:
    """Return why a sentence is refused, empty if it is permitted; `known` are words that it can also contain."""
    if len(sentence) > MAX_LENGTH:
        return "it is too long"
    if reason := _other_language(sentence, language):
        return reason
    given = unicodedata.normalize("NFKC", " ".join((*passages, *known))).casefold()
    sentence = unicodedata.normalize("NFKC", sentence)
    there = frozenset(_words(given))
    for found in ADDRESS.finditer(sentence):
        around = next(w for w in re.finditer(r"\S+", sentence) if w.start() <= found.start() < w.end())
        if around.group().strip(".,!?").casefold() not in given.split():
            return "it contains an address that is in no passage"
    for word in _words(sentence.casefold()):
        if (any(sign.isnumeric() for sign in word) or word in NUMBERS) and word not in there:
            return f"it contains the number `{word[:20]}`, which is in no passage"
    for word in _names(sentence, WORDS.get(language, frozenset())):
        if {word.casefold(), _bare(word)}.isdisjoint(there):
            return f"it contains the name `{word[:20]}`, which is in no passage"
    return ""


def _other_language(sentence: str, language: str) -> str:
    wanted = WORDS.get(language)
    if wanted is None:
        return f"Lumen cannot check whether it is in `{language}`"
    if any(sign.isalpha() and not unicodedata.name(sign, "").startswith("LATIN") for sign in sentence):
        return f"it is not in `{language}`"
    said = _words(sentence.casefold())
    counts = {other: sum(word in common for word in said) for other, common in WORDS.items()}
    most = max(counts.values())
    if counts[language] < most or (counts[language] == 0 and len(said) > 2):
        return f"it is not in `{language}`"
    return ""


def _names(sentence: str, common: frozenset[str]) -> Iterator[str]:
    """Yield the sentence's words that contain a capital letter, except the most common words."""
    for word in re.findall(r"[^\W_]+(?:['’-][^\W_]+)*", sentence):
        if any(sign.isupper() for sign in word) and _bare(word) not in common:
            yield word


def _bare(word: str) -> str:
    """Return a case-folded word without the part after an apostrophe: `johann` for `Johann's`."""
    return re.split(r"['’]", word)[0].casefold()


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W_]+(?:['’-][^\W_]+)*", text)

"""A language model of bigrams: what is expected, word by word, and beside it the common words of the language."""

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from math import log10

COMMON_WEIGHT = 0.75
"""How much of the chance of a word is that of the language, and not that of the expected sentences.

With less, more of these is understood where it is quiet, and more of other talk is taken for one where it is not.
"""
SENTENCE_BEGIN, SENTENCE_END = "<s>", "</s>"


def arpa(sentences: Sequence[Sequence[str]], common: Mapping[str, float]) -> str:
    """The model in ARPA's format; `common` are words with their chances.

    Bigrams are smoothed as Witten and Bell (1991) have it: a word that many different ones follow leaves much to words
    that never followed it. Without the common words everything that is said would be taken for something expected.
    """
    pairs = Counter(pair for s in sentences for pair in zip([SENTENCE_BEGIN, *s], [*s, SENTENCE_END], strict=True))
    seen: dict[str, int] = Counter()
    followers: dict[str, set[str]] = defaultdict(set)
    for (word, after), count in pairs.items():
        seen[word] += count
        followers[word].add(after)
    chances = _chances(Counter(after for _, after in pairs.elements()), common)
    known = {word: count / (count + len(followers[word])) for word, count in seen.items()}
    lines = ["\\data\\", f"ngram 1={len(chances) + 1}", f"ngram 2={len(pairs)}", "", "\\1-grams:"]
    lines.append(f"-99 {SENTENCE_BEGIN} {log10(1 - known[SENTENCE_BEGIN]):.4f}")
    lines += [f"{log10(p):.4f} {w} {log10(1 - known.get(w, 0.0)):.4f}" for w, p in sorted(chances.items())]
    lines += ["", "\\2-grams:"]
    for (word, after), count in sorted(pairs.items()):
        part = known[word]
        lines.append(f"{log10(part * count / seen[word] + (1 - part) * chances[after]):.4f} {word} {after}")
    return "\n".join([*lines, "", "\\end\\", ""])


def _chances(expected: Mapping[str, int], common: Mapping[str, float]) -> dict[str, float]:
    """The chance of each word by itself."""
    total, whole = sum(expected.values()), sum(common.values())
    share = COMMON_WEIGHT if common else 0.0
    chances = {word: (1 - share) * count / total for word, count in expected.items()}
    for word, chance in common.items():
        chances[word] = chances.get(word, 0.0) + share * chance / whole
    return chances

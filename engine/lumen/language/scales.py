"""Scales of words, such as cold, warm, hot: fuzzy terms with such names should be in the same order."""

SCALES: tuple[tuple[tuple[str, ...], ...], ...] = (
    (("negative", "neg", "minus"), ("zero", "neutral", "center", "centre", "null"), ("positive", "pos", "plus")),
    (("tiny",), ("small", "few", "little"), ("medium", "middle", "some"), ("big", "large", "many", "much"), ("huge",)),
    (("lowest",), ("low",), ("medium", "middle", "normal", "mid"), ("high",), ("highest",)),
    (("freezing",), ("cold",), ("cool",), ("warm",), ("hot",)),
    (("near", "close"), ("medium", "middle"), ("far", "distant")),
    (("slow",), ("medium", "moderate"), ("fast", "quick")),
    (("short",), ("medium",), ("long",)),
    (("dark",), ("dim", "medium"), ("bright",)),
    (("bad", "poor"), ("fair", "average", "medium"), ("good",), ("excellent",)),
    (("weak",), ("medium",), ("strong",)),
    (("young",), ("medium",), ("old",)),
)


def ranks(names: tuple[str, ...]) -> dict[str, int]:
    """Return the ranks of the names that are on one scale: the scale with the most of these names.

    The result is empty if no scale has two of the names with different ranks.
    """
    best: dict[str, int] = {}
    for scale in SCALES:
        words = {word: rank for rank, step in enumerate(scale) for word in step}
        found = {name: words[name.lower()] for name in names if name.lower() in words}
        if len(set(found.values())) > 1 and len(found) > len(best):
            best = found
    return best

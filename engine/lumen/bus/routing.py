"""Which keys a pattern stands for, as an AMQP 0-9-1 topic exchange decides it.

Keys and patterns are words with dots between them; in a pattern `*` stands for exactly one word and `#` for any number
of them, none included. An empty key has no words.
"""

from functools import lru_cache


@lru_cache(maxsize=16_384)
def matches(pattern: str, key: str) -> bool:
    """Whether a message with this key goes to who subscribed to `pattern`; remembered for each pair."""
    return _match(_words(pattern), _words(key))


@lru_cache(maxsize=4_096)
def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split(".")) if text else ()


def _match(pattern: tuple[str, ...], key: tuple[str, ...]) -> bool:
    """Compare word by word; where that fails, the last `#` takes one word more. At most |pattern| x |key| steps."""
    p = k = taken = 0
    hash_at = -1
    while k < len(key):
        if p < len(pattern) and pattern[p] == "#":
            hash_at, taken, p = p, k, p + 1
        elif p < len(pattern) and pattern[p] in ("*", key[k]):
            p, k = p + 1, k + 1
        elif hash_at >= 0:
            taken += 1
            p, k = hash_at + 1, taken
        else:
            return False
    return all(word == "#" for word in pattern[p:])

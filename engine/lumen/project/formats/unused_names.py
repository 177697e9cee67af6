"""Choose a name that is not taken yet: `wave`, or `wave_2` if there is a `wave` already."""

from collections.abc import Callable


def unused_name(stem: str, is_taken: Callable[[str], bool], many: int) -> str:
    """Return the stem, or else the first of `stem_2`, `stem_3`, … that is not taken.

    `many` is how many names there may be: after the first hundred, the numbers increase in steps of that size.
    """
    name, number = stem, 1
    while is_taken(name):
        number += 1 if number < 100 else max(many, 1)
        name = f"{stem}_{number}"
    return name

"""Choose a name that is not taken yet: `wave`, or `wave_2` if there is a `wave` already."""

from collections.abc import Callable


def unused_name(stem: str, is_taken: Callable[[str], bool], many: int) -> str:
    """Return the stem, or else the first of `stem_2`, `stem_3`, … that is not taken.

    After the first hundred numbers, only every `many`th one is tried. `many` is the number of names there may be, so
    the search is short even if all of them share the stem.
    """
    name, number = stem, 1
    while is_taken(name):
        number += 1 if number < 100 else max(many, 1)
        name = f"{stem}_{number}"
    return name

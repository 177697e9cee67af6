"""Names beside others: `wave`, and where there is one already, `wave_2`."""

from collections.abc import Callable


def unused_name(stem: str, is_taken: Callable[[str], bool], many: int) -> str:
    """The stem, or else the first `stem_2`, `stem_3`, … that is not taken.

    `many` is how many names there may be: after a hundred in vain the numbers go on in steps of that.
    """
    name, number = stem, 1
    while is_taken(name):
        number += 1 if number < 100 else max(many, 1)
        name = f"{stem}_{number}"
    return name

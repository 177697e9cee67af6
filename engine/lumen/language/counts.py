"""Counts with their nouns, as they are printed."""


def counted(number: float, noun: str, many: str = "") -> str:
    """Return the number and its noun: `1 text`, `2,000 texts`; `many` is the plural if it is not formed with `s`."""
    shown = f"{number:,}" if isinstance(number, int) else f"{number:g}"
    return f"{shown} {noun if number == 1 else many or f'{noun}s'}"

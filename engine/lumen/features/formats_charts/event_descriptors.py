"""Descriptors of events, `a.b`, `a.*` and `*`: which are equal, and which can match the same event."""


def normal(descriptor: str) -> str:
    """Return `a` for `a`, `a.` and `a.*` (SCXML 3.12.1)."""
    return "*" if descriptor == "*" else descriptor.removesuffix("*").rstrip(".") if "." in descriptor else descriptor


def overlap(one: str, other: str) -> bool:
    """Return whether an event can match both descriptors."""
    return "*" in (one, other) or f"{one}.".startswith(f"{other}.") or f"{other}.".startswith(f"{one}.")

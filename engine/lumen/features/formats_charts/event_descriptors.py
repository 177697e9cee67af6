"""Normalizes and compares event descriptors: `a.b`, `a.*` and `*`."""


def normal(descriptor: str) -> str:
    """Return a descriptor's normal form: `a` for `a`, `a.` and `a.*` (SCXML 3.12.1); `*` stays `*`."""
    return "*" if descriptor == "*" else descriptor.removesuffix("*").rstrip(".") if "." in descriptor else descriptor


def overlap(one: str, other: str) -> bool:
    """Return whether an event can match both descriptors."""
    return "*" in (one, other) or f"{one}.".startswith(f"{other}.") or f"{other}.".startswith(f"{one}.")

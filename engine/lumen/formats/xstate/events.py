"""Descriptors of events: XState's match a name exactly, ours everything that begins with it."""

import re

_DESCRIPTOR = re.compile(r"\*|[^\s.*]+(\.[^\s.*]+)*(\.\*)?")


def descriptor_of(event: str) -> str | None:
    """A key of XState's `on` as a key of ours, None where none is meant."""
    text = re.sub(r"\s+", "_", event.strip())
    return text if _DESCRIPTOR.fullmatch(text) else None

"""Saving a watched file."""

from pathlib import Path


def save(file: Path, text: str) -> None:
    """Save the file in one step, so that nothing reads half of it."""
    draft = file.with_name(f".{file.name}.new")
    draft.write_text(text, "utf-8")
    draft.replace(file)

"""A function of expressions."""


def shout(text: str, marks: int) -> str:
    """The text in capital letters, with exclamation marks."""
    return text.upper() + "!" * marks

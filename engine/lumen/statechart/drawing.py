"""Drawing one of several alternatives, from a generator that is part of the snapshot."""


def draw(generator: int, count: int) -> tuple[int, int]:
    """One of `count` alternatives, from 0, and the generator after it (Numerical Recipes' linear congruence)."""
    if count == 1:
        return 0, generator
    generator = (generator * 1664525 + 1013904223) % 2**32
    return (generator >> 16) % count, generator

"""Random choice among alternatives, with a generator that is part of the snapshot."""


def draw(generator: int, count: int) -> tuple[int, int]:
    """Return a number from 0 to `count` - 1, and the next generator state (the LCG of Numerical Recipes)."""
    if count == 1:
        return 0, generator
    generator = (generator * 1664525 + 1013904223) % 2**32
    # The low bits of such a generator have short periods
    return (generator >> 16) % count, generator

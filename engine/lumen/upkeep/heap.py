"""Return of unused memory to the system in long runs."""

import ctypes

TRIM_THRESHOLD, MMAP_THRESHOLD = -1, -3
"""The parameters of the C library that are set (`malloc.h`)."""
LARGE = 128 * 1024
"""Size from which a block is mapped separately and returned when freed [bytes]; this is glibc's initial value."""


def give_back() -> None:
    """Make glibc return freed memory from now on; with another C library nothing changes.

    By default it keeps ever larger blocks, between which live data is scattered: each saved file cost a running
    exhibition 0.5 MB.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError, TypeError):
        return
    mallopt(MMAP_THRESHOLD, LARGE)
    mallopt(TRIM_THRESHOLD, LARGE)

"""Memory that a long run has no use for any more goes back to the system."""

import ctypes

TRIM_THRESHOLD, MMAP_THRESHOLD = -1, -3
"""Which of its limits the C library is told (`malloc.h`)."""
LARGE = 128 * 1024
"""From this size on a block is asked of the system itself, and given back when it is freed [bytes]: as glibc begins."""


def give_back() -> None:
    """Let what is freed be given back from now on, where the C library is glibc; else nothing changes.

    By itself it keeps larger and larger blocks, between which what stays lies scattered: each saved file cost a running
    exhibition 0.5 MB.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError, TypeError):
        return
    mallopt(MMAP_THRESHOLD, LARGE)
    mallopt(TRIM_THRESHOLD, LARGE)

"""What a job and who asks for it go by."""

JOB_TIME = 240.0
"""The time limit of a job with its wait for those before it [s]; a small and busy machine needs minutes."""
NOTHING = b"null"
"""The answer of a job that found nothing."""
MAX_SHOWN = 5_000
"""Entries of a visit that a page gets."""

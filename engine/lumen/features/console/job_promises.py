"""Constants shared by the jobs and the console that starts them."""

JOB_TIME = 240.0
"""The time limit of a job with its wait for those before it [s]; a small and busy machine needs minutes."""
NOTHING = b"null"
"""The answer of a job that found nothing."""
MAX_SHOWN = 5_000
"""The most entries of a visit that a page gets."""

"""Constants shared by the jobs and the console that starts them."""

JOB_TIME = 240.0
"""The time limit of a job, including its wait in the queue [s]; a small, busy machine needs minutes."""
NOTHING = b"null"
"""The answer of a job that found nothing."""
MAX_SHOWN = 5_000
"""The maximum number of entries of a visit that a page receives."""

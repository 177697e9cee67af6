"""What a job and who asks for it go by."""

JOB_TIME = 240.0
"""How long a job may take, with its wait for those before it [s]: minutes on a small and busy machine."""
NOTHING = b"null"
"""The answer of a job that found nothing."""
REFUSED, OUT_OF_MEMORY = 76, 77
"""Exit codes: what it wrote is the reason why there is no answer; it was refused more memory."""

"""What all tests may ask for, and which examples hypothesis draws: the same in every run."""

from hypothesis import settings

from tests.rabbitmq import broker

__all__ = ["broker"]

settings.register_profile("seeded", derandomize=True, deadline=None)
settings.load_profile("seeded")

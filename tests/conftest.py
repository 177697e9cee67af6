"""What all tests may ask for, how they are marked, and which examples hypothesis draws: the same in every run."""

from hypothesis import settings

from tests.marking import pytest_collection_modifyitems
from tests.rabbitmq import broker

__all__ = ["broker", "pytest_collection_modifyitems"]

settings.register_profile("seeded", derandomize=True, deadline=None)
settings.load_profile("seeded")

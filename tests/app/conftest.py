"""A copy of the shipped exhibition, to be changed."""

from tests.tour.conftest import copy

__all__ = ["copy"]

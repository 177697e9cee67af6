"""A copy of the shipped project, to be changed."""

from tests.tour.conftest import copy

__all__ = ["copy"]

"""The shipped project and copies of it, for the command line's tests."""

from tests.tour.conftest import copy, project

__all__ = ["copy", "project"]

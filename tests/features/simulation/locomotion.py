"""Arenas and tasks of dm_control, which import labmaze; without it, files of tests that use them are skipped."""

import sys

import pytest

__all__ = ["floors", "go_to_target"]

if sys.version_info < (3, 13):  # as in pyproject.toml
    from dm_control.locomotion.arenas import floors
    from dm_control.locomotion.tasks import go_to_target
else:
    pytest.skip("labmaze has no wheel for Python 3.13 and later", allow_module_level=True)

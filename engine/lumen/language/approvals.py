"""The autonomy of a robot: whether transitions with `approve: operator` wait for a person."""

from typing import Literal

Autonomy = Literal["ask", "alone"]
"""`ask`: such transitions wait for the operator's GO; `alone`: they are performed without it."""

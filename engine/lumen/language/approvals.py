"""The autonomy of a robot: whether transitions with `approve: operator` wait for a person."""

from typing import Literal

Autonomy = Literal["ask", "alone"]
"""`ask`: they wait for GO; `alone`: they are performed without it."""

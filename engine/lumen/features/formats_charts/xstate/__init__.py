"""XState v5's machine configurations as JSON, in and out."""

from lumen.formats.xstate.reader import read_xstate
from lumen.formats.xstate.writer import write_xstate

__all__ = ["read_xstate", "write_xstate"]

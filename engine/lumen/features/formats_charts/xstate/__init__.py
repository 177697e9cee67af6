"""Import and export of XState v5's machine configurations as JSON."""

from lumen.features.formats_charts.xstate.reader import read_xstate
from lumen.features.formats_charts.xstate.writer import write_xstate

__all__ = ["read_xstate", "write_xstate"]

"""The database module: what happened, and who was there, in SQLite."""

from lumen.modules.memory.memory import Memory
from lumen.modules.memory.store import Entry, Store

__all__ = ["Entry", "Memory", "Store"]

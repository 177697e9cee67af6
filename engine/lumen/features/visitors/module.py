"""The database module: what happened, and who was there, in SQLite."""

from lumen.modules.memory.memory import Memory
from lumen.modules.memory.store import JournalEntry, Store

__all__ = ["JournalEntry", "Memory", "Store"]

"""The database module: the journal and the known visitors, in SQLite."""

from lumen.features.visitors.memory import Memory
from lumen.features.visitors.store import JournalEntry, Store

__all__ = ["JournalEntry", "Memory", "Store"]

"""Retrieval: the passage of knowledge/ that answers a question best, and how sure that is."""

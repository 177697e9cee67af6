"""A journal that is replayed: which part of it is meant, the files that ran then, and what came of it."""

"""The replay of a journal: the choice of its part, the files that ran then, and the result."""

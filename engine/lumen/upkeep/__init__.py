"""Infrastructure for long runs: watched threads and processes, counts of drops, rate limits, garbage collection."""

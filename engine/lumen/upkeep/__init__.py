"""Infrastructure of a long run: watched threads, counts of drops, rate limits, pauses between attempts."""

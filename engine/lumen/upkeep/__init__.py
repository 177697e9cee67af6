"""What keeps an exhibition going: watched threads, counts of drops, limits of rate, pauses between attempts."""

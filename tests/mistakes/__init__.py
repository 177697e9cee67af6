"""What lint makes of mistakes that people make, and of what is right; `python -m tests.mistakes` prints the scores."""

"""Which of the things that are known answers a question."""

"""The explain page of the console."""

"""The explain pages for alerts."""

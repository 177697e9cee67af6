"""The explain pages of alerts."""

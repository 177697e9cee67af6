"""The explain pages of show control."""

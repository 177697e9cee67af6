"""The explain pages for show control."""

"""The explain pages of fleets."""

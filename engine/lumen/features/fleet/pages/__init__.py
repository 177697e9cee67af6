"""The explain pages for fleets."""

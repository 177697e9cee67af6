"""A page for each code of the stranger's rules."""

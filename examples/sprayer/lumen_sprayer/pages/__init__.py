"""A page for each code of lint."""

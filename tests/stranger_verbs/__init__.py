"""A verb of an installed package: it works wherever a user meets a verb."""

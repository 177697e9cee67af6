"""Why and why not, replay, exploration, differences and migration, all of it pure."""

"""A statechart, a fuzzy controller or a motion without a project around it: its class, loaded from a file."""

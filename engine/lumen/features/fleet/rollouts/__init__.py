"""A fleet, pure: how a rollout goes on, what a robot takes, what they tell each other."""

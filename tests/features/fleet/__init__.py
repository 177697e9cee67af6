"""Many houses: fleet.yaml, rollouts, the agent of a robot, brokers."""

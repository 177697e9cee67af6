"""A fleet at its edges: signed bundles, the agent of a robot, the centre, and what their brokers are told."""

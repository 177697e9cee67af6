"""Pure analyses of steps and bundles: why and why not, replay, exploration, differences and migration."""

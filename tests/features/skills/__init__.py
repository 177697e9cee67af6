"""Skills: manifests, the programs that perform them, and what happens if these misbehave."""

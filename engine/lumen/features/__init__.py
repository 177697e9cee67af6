"""The manifests of the features that come with Lumen; each imports `lumen.feature` and nothing else."""

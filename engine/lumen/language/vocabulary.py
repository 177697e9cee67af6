"""The version of the YAML's vocabulary, a number: `lumen:` in lumen.yaml names the version of a project's files."""

VOCABULARY = 1
"""The version that this Lumen reads. The number grows only if a valid file would get another meaning, or none."""
FIRST_VOCABULARY = 1
"""The version of files that do not name a version."""
VOCABULARY_KEY = "lumen"
"""The key of lumen.yaml that names the vocabulary."""

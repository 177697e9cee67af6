"""The words of the YAML as a whole, by a number: what `lumen:` in lumen.yaml says its files were written for."""

VOCABULARY = 1
"""The one that this Lumen reads. It grows only where a file that was right would mean something else, or nothing."""
FIRST_VOCABULARY = 1
"""That of files which do not say."""
VOCABULARY_KEY = "lumen"
"""The key of lumen.yaml that says it."""

"""The pages for the skills' diagnostic codes, in the format that `lumen.lint.pages` describes."""

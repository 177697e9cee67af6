"""A page for each code of skills, in the form that `lumen.lint.pages` describes."""

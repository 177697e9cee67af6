"""Pages of `lumen explain` about Reachy Mini: one for each code."""

"""Files of an older vocabulary: rewritten with their comments, or reported with instructions."""

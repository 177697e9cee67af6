"""Files of an older vocabulary: rewritten with their comments, or told what to do about them."""

"""What Lumen did at d475a3ac, kept to the byte, so that code can move without changing what it does."""

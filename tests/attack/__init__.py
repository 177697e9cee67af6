"""What anybody may send or save, at random and on purpose."""

"""What keeps an exhibition going: threads that are begun again, a count of what is dropped, limits of rate."""

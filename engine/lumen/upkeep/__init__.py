"""What keeps an exhibition going: threads that are begun again, and a count of what is dropped."""

"""A module for each subject; its `record(folder)` writes into the folder what is kept, the same bytes each time."""

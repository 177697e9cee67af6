"""What lint finds in projects that somebody names: by their files, by a reload, and by physics."""

"""What a stranger adds to Lumen; it knows only what Lumen's documentation promises."""

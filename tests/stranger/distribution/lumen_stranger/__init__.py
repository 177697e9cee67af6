"""The additions of a stranger to Lumen, who knows only what Lumen's documentation promises."""

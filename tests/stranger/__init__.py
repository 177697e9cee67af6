"""Features of strangers: what a package adds that somebody installs beside Lumen, and what happens if it is faulty."""

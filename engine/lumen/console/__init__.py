"""The console: pages in a browser for the people who run an exhibition, served by a client of its bus."""

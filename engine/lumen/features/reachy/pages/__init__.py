"""What lint found about Reachy Mini, and what to do: a page for each code."""

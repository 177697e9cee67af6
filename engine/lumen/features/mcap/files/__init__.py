"""Recordings of a bus in MCAP, which Foxglove and Lichtblick open: written, read, recovered, copied.

The packages that this needs are the extra `recording`; they are imported when a recording is written or read.
"""

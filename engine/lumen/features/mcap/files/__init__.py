"""Recordings of a bus in MCAP, for Foxglove and Lichtblick: written, read, repaired, copied.

The required packages are the extra `recording`; they are imported when a recording is written or read.
"""

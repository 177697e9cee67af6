"""Writes, reads, repairs and copies recordings of a bus in MCAP, for Foxglove and Lichtblick.

The packages of the extra `recording` are imported when a recording is written or read.
"""

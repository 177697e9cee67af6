"""The journal of inputs on the disk: frames of bytes, files of frames, who writes them, and who reads them.

`lumen.insight.replay` defines the entries.
"""

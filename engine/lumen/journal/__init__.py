"""The journal of inputs on the disk: frames of bytes, files of frames, who writes them, and who reads them.

What an entry is stands in `lumen.insight.replay`.
"""

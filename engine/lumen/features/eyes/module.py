"""The visual module: faces, whose they are, and people, found with OpenCV in what a camera sees."""

from lumen.features.eyes.eyes import Eyes

__all__ = ["Eyes"]

"""The visual module: faces, whose they are, and people, found with OpenCV in what a camera sees."""

from lumen.modules.eyes.eyes import Eyes

__all__ = ["Eyes"]

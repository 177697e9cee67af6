"""The visual module: faces, their names, and people, found with OpenCV in a camera's images."""

from lumen.features.eyes.eyes import Eyes

__all__ = ["Eyes"]

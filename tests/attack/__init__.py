"""Attacks with hostile messages, frames and files, random and hand-written."""

"""Recordings of Lumen at d475a3ac, to the byte: code can move without changing its behaviour unnoticed."""

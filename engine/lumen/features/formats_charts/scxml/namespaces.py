"""The names of SCXML's elements and invocations, and the namespace of Lumen's own."""

SCXML_NAMESPACE = "http://www.w3.org/2005/07/scxml"

SCXML_INVOKE_TYPE = "http://www.w3.org/TR/scxml/"
"""The type of an `<invoke>` of another chart (SCXML 6.4.3)."""

LUMEN_NAMESPACE = "urn:lumen:behavior"
"""The namespace of what only Lumen has: `do`, robot verbs, phrases, answers."""

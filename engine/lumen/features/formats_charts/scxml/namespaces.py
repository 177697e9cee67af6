"""The namespaces of SCXML's and Lumen's elements, and the type of invocations."""

SCXML_NAMESPACE = "http://www.w3.org/2005/07/scxml"

SCXML_INVOKE_TYPE = "http://www.w3.org/TR/scxml/"
"""The `type` of an `<invoke>` that runs another chart (SCXML 6.4.3)."""

LUMEN_NAMESPACE = "urn:lumen:behavior"
"""The namespace for features that only Lumen has: `do`, robot verbs, phrases and answers."""

"""Why, and why not: answers from recorded steps, checked by removing the named causes."""

"""Why, and why not: asked of what was recorded, and checked by doing without what was named."""

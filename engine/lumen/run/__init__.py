"""An exhibition as a whole: its loop, its parts, reload, recovery and stories."""

"""Run an exhibition as a whole: its loop, parts, reload, recovery and stories."""

"""An exhibition as a whole: where its parts meet, are hosted, reloaded, recovered, rehearsed and explored."""

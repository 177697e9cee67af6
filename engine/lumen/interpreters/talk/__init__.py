"""What visitors say, and which phrases are in it: folding of words, patterns, finding, and the rows of `hears`."""

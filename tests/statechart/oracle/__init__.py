"""A second reading of SCXML's Appendix D, as slow and as literal as it can be, to compare the interpreter with."""

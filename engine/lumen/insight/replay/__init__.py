"""The content of a journal of inputs, and its replay.

`entries` has the values, `digest` reduces a step to eight digits, `replaying` repeats the steps, `visits` finds the
beginning and end of each visit, and `against` plays a visit under other files.
"""

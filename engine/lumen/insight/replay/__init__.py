"""What a journal of inputs holds, and the same steps taken again from it: entries and bundles in, steps out.

`entries` are the values, `digest` what a step comes to in eight digits, `replaying` takes the steps again, `visits`
says where one visit begins and ends, `against` plays a visit under other files.
"""
